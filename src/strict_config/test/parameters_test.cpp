#include "strict_config/parameters.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST(Number, ShortestDecimalReadsBackToTheSameBits) {
  EXPECT_EQ(ShortestDecimal(0.1), "0.1");
  EXPECT_EQ(ShortestDecimal(100000.0), "100000");
  EXPECT_EQ(ShortestDecimal(80.0), "80");
  EXPECT_EQ(ShortestDecimal(-0.0), "-0");
  EXPECT_EQ(ShortestDecimal(0.1 + 0.2), "0.30000000000000004");
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::optional<double> back = ParseNumber(ShortestDecimal(value));
    ASSERT_TRUE(back) << ShortestDecimal(value);
    EXPECT_EQ(*back, value) << ShortestDecimal(value);
    EXPECT_EQ(std::signbit(*back), std::signbit(value)) << ShortestDecimal(value);
  }
}

TEST(Ranges, RulesInWords) {
  EXPECT_EQ(kFinite.Rule(), "must be a finite number");
  EXPECT_EQ(kPositive.Rule(), "must be > 0");
  EXPECT_EQ(kNonNegative.Rule(), "must be >= 0");
  EXPECT_EQ(kFraction.Rule(), "must be in [0, 1]");
  EXPECT_EQ((Range{0.0, 0.5, true, false}.Rule()), "must be in (0, 0.5]");
  EXPECT_EQ((Range{-std::numeric_limits<double>::infinity(), 3.0, true, true}.Rule()), "must be < 3");
  EXPECT_EQ((Range{-std::numeric_limits<double>::infinity(), 3.0, true, false}.Rule()), "must be <= 3");
}

}  // namespace
}  // namespace strict_config
