#include "train_dynamics/brake/pneumatic/air_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace train_dynamics {
namespace {

std::vector<std::string> Failures(const std::vector<AirTestResult>& results) {
  std::vector<std::string> failed;
  for (const AirTestResult& r : results)
    if (!r.passed) failed.push_back(r.test.substr(0, r.test.find(':')));
  return failed;
}

TEST(AirTest, ASoundTrainPassesAll) {
  const auto results = TestAirBrake(PneumaticBrakeParams{}, std::vector<double>(60, 13.0));
  EXPECT_EQ(Failures(results), std::vector<std::string>{});
  EXPECT_GE(results.size(), 12u);
}

TEST(AirTest, ALeakingTrainFailsItsLeakageTest) {
  PneumaticBrakeParams params;
  params.pipe.leakage_g_per_s_km = 60.0;
  const auto failed = Failures(TestAirBrake(params, std::vector<double>(60, 13.0)));
  EXPECT_EQ(std::count(failed.begin(), failed.end(), "leakage"), 2) << "flow and fall";
}

TEST(AirTest, AClosedAngleCockIsFound) {
  PneumaticBrakeParams params;
  params.closed_angle_cocks = {30};
  const auto failed = Failures(TestAirBrake(params, std::vector<double>(60, 13.0)));
  EXPECT_GE(std::count(failed.begin(), failed.end(), "emergency"), 1);
  EXPECT_GE(std::count(failed.begin(), failed.end(), "charging"), 1);
}

TEST(AirTest, ALeakingCylinderFailsTheSingleCarTest) {
  PneumaticBrakeParams params;
  params.valves[0].direct.limiting_opening_mm = 0.0;  // or the pipe makes good for it
  params.valves[0].cylinder_leakage_kpa_per_min = 20.0;
  const auto failed = Failures(TestAirBrake(params, std::vector<double>(20, 13.0)));
  EXPECT_EQ(std::count(failed.begin(), failed.end(), "single car"), 1);
}

}  // namespace
}  // namespace train_dynamics
