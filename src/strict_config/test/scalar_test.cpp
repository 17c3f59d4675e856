#include "strict_config/scalar.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST(Number, AcceptsPlainDecimals) {
  const std::pair<const char*, double> numbers[] = {
      {"0", 0.0},     {"-3", -3.0}, {"+4", 4.0},       {"0.5", 0.5}, {".5", 0.5},  {"2.", 2.0},       {"1e8", 1e8},
      {"1e-3", 1e-3}, {"1E3", 1e3}, {"1.5e+6", 1.5e6}, {"-0", -0.0}, {"0e0", 0.0}, {"5e-324", 5e-324}};
  for (const auto& [text, value] : numbers) {
    const std::optional<double> parsed = ParseNumber(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(*parsed, value) << text;
    EXPECT_EQ(std::signbit(*parsed), std::signbit(value)) << text;
  }
}

TEST(Number, RefusesEverythingElse) {
  for (const char* text :
       {"",    "+",  "-",     ".",   "e5",  "1e",   "1e+", "--1",   "+-1",      "1 ",   " 1",    "1.2.3", "0x10",
        "010", "00", "1_000", "1,5", "nan", ".nan", "inf", "-.inf", "Infinity", "true", "1e999", "1:30",  "1f"}) {
    EXPECT_FALSE(ParseNumber(text)) << text;
  }
}

TEST(Number, RuleSaysHowToRepair) {
  EXPECT_EQ(NumberRule("80 km/h", false, "initial_speed_kmh"),
            "must be a plain number in km/h (the unit is in the key)");
  EXPECT_EQ(NumberRule("30%", false, "ratio"), "must be a plain number, without a unit");
  EXPECT_EQ(NumberRule("80", true, "x_m"), "must be a number without quotes");
  EXPECT_EQ(NumberRule("0,5", false, "x_m"), "must be a plain number, with a point for decimals");
  EXPECT_EQ(NumberRule("1_000", false, "x_m"), "must be a plain number, without separators");
  EXPECT_EQ(NumberRule("010", false, "x_m"), "must be a plain decimal number, without leading zeros");
  EXPECT_EQ(NumberRule("0x10", false, "x_m"), "must be a plain decimal number");
  EXPECT_EQ(NumberRule("0o17", false, "x_m"), "must be a plain decimal number");
  EXPECT_EQ(NumberRule("-.INF", false, "x_m"), "must be a finite number");
  EXPECT_EQ(NumberRule("1e999", false, "x_m"), "must be a number within the range of double precision");
  EXPECT_EQ(NumberRule("fast", false, "x_m"), "must be a number");
  EXPECT_EQ(NumberRule("1.2.3", false, "x_m"), "must be a number");
  EXPECT_EQ(NumberRule("1 ", false, "x_m"), "must be a number");
}

TEST(Units, AreTheEndOfAKey) {
  const auto expect = [](const char* key, const char* stem, const char* unit) {
    EXPECT_EQ(SplitUnit(key).stem, stem) << key;
    EXPECT_EQ(SplitUnit(key).unit, unit) << key;
  };
  expect("initial_speed_kmh", "initial_speed", "km/h");
  expect("stiffness_n_per_m", "stiffness", "N/m");
  expect("damping_ns_per_m", "damping", "N s/m");
  expect("rate_kpa_per_s", "rate", "kPa/s");
  expect("curvature_per_m", "curvature", "1/m");
  expect("inertia_kgm2", "inertia", "kg m^2");
  expect("friction_coefficient", "friction_coefficient", "");
  expect("count", "count", "");
  expect("m", "m", "");  // a unit alone is a name
  expect("miles_per", "miles_per", "");
}

}  // namespace
}  // namespace strict_config
