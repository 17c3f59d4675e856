#include "strict_config/validate.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST(Validation, SaysTheSameAsTheReader) {
  Scenario s;
  s.initial_speed_kmh = -1.0;
  s.detailed = {1, -2};
  s.consist.resize(1);
  s.consist[0].count = 0;
  s.consist[0].vehicle.mass_kg = -0.4;
  s.tail.emplace();
  s.spare_couplers.resize(1);
  s.spare_couplers[0].slack_m = 2.0;
  s.spare_couplers[0].kind = static_cast<CouplerKind>(7);
  s.patch.emplace().friction_coefficient = 2.0;
  try {
    Validate(s);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "initial_speed_kmh must be >= 0, got -1\n"
                 "detailed[1] must be >= 0, got -2\n"
                 "consist[0].count must be in [1, 1000], got 0\n"
                 "consist[0].vehicle.mass_kg must be > 0, got -0.4\n"
                 "consist[0].vehicle.coupler.slack_m is missing (must be >= 0)\n"
                 "spare_couplers[0].kind must be one of its named values\n"
                 "patch.friction_coefficient must be in [0, 1], got 2\n"
                 "tail.slack_m is missing (must be >= 0)");
  }
  EXPECT_THROW(Write(s), std::invalid_argument);
  EXPECT_THROW(Validate(Stages()), std::invalid_argument);
  EXPECT_NO_THROW(Validate(Scenario()));
}

TEST(Validation, RulesBetweenFields) {
  Coupler coupler;
  coupler.slack_m = 2.0;
  try {
    Validate(coupler);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "slack_m must be less than the length of a vehicle");
  }
}

}  // namespace
}  // namespace strict_config
