#include "strict_config/error_list.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST_F(ConfigTest, AllErrorsInOrderOfLines) {
  EXPECT_EQ(ErrorsOf("initial_speed_mps: 20\n"
                     "commands:\n"
                     "  - {time_s: -1}\n"
                     "  - {tme_s: 2, reduction_kpa: x}\n"
                     "record: 1\n"),
            "a.yaml:1: initial_speed_mps is not a known key; the key is initial_speed_kmh, in km/h\n"
            "a.yaml:3: commands[0].time_s must be >= 0, got -1\n"
            "a.yaml:4: commands[1].time_s is missing (must be >= 0)\n"
            "a.yaml:4: commands[1].reduction_kpa must be a number, got 'x'\n"
            "a.yaml:4: commands[1].tme_s is not a known key; did you mean time_s?\n"
            "a.yaml:5: record must be true or false, got 1");
}

TEST_F(ConfigTest, ManyErrorsAreCutShort) {
  std::string text = "detailed:\n";
  for (int i = 0; i < 62; ++i) text += "  - x\n";
  const std::string errors = ErrorsOf(text);
  EXPECT_EQ(errors.substr(errors.rfind('\n')), "\nand 12 more");
  EXPECT_EQ(found.size(), 62u);
}

TEST_F(ConfigTest, LoadThrowsAllErrors) {
  const std::string file = Put("a.yaml", "record: 1\ndetailed: 2\n");
  try {
    Load<Scenario>(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(WithoutFolder(error.what()),
              "a.yaml:1: record must be true or false, got 1\n"
              "a.yaml:2: detailed must be a list of whole numbers, got 2");
  }
}

}  // namespace
}  // namespace strict_config
