#include "train_brake_rviz/board/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace train_brake_rviz {
namespace {

TEST(NiceCeiling, IsTheNextRoundNumber) {
  for (double value = 1.3e-4; value < 1e7; value *= 1.07) {
    const double nice = NiceCeiling(value);
    EXPECT_GE(nice, value * (1.0 - 1e-9));
    EXPECT_LT(nice, 2.5 * value);  // the largest gap is from 2 to 5
    const double digit = nice / std::pow(10.0, std::floor(std::log10(nice) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1.0) < 1e-9 || std::abs(digit - 2.0) < 1e-9 || std::abs(digit - 5.0) < 1e-9) << nice;
  }
}

TEST(NiceCeiling, LeavesRoundNumbersAsTheyAre) {
  for (const double round : {0.001, 0.02, 0.2, 0.5, 1.0, 2.0, 50.0, 1000.0}) {
    EXPECT_DOUBLE_EQ(round, NiceCeiling(round));
  }
}

TEST(Axis, IsLinearBetweenItsEnds) {
  const Axis axis = {-200.0, 600.0, 10.0, 30.0};
  EXPECT_DOUBLE_EQ(10.0, axis(-200.0));
  EXPECT_DOUBLE_EQ(30.0, axis(600.0));
  EXPECT_DOUBLE_EQ(0.5 * (axis(-100.0) + axis(300.0)), axis(100.0));
  EXPECT_DOUBLE_EQ(30.0, axis.Clamped(1e9));
  EXPECT_DOUBLE_EQ(10.0, axis.Clamped(-1e9));
}

TEST(Axis, TicksAreRoundAndWithin) {
  for (const double span : {0.3, 1.0, 7.0, 241.0, 2000.0}) {
    const Axis axis = {-0.4 * span, 0.6 * span, 0.0, 1.0};
    const std::vector<double> ticks = axis.Ticks(5);
    ASSERT_GE(ticks.size(), 2u);
    EXPECT_LE(ticks.size(), 9u);
    const double distance = ticks[1] - ticks[0];
    EXPECT_NEAR(distance, NiceCeiling(distance), 1e-9 * distance);
    for (const double tick : ticks) {
      EXPECT_GE(tick, axis.min - 1e-6 * span);
      EXPECT_LE(tick, axis.max + 1e-6 * span);
      EXPECT_NEAR(0.0, std::remainder(tick, distance), 1e-9 * span);
    }
  }
}

TEST(Axis, HasFewTicksWhateverTheNumbersAre) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE((Axis{kNan, kNan, 0.0, 1.0}).Ticks(5).empty());
  EXPECT_LE((Axis{1e300, 1e300 + 1.0, 0.0, 1.0}).Ticks(5).size(), 100u);
  EXPECT_LE((Axis{1e17, 1e17 + 64.0, 0.0, 1.0}).Ticks(5).size(), 100u);  // numbers that are 16 apart
}

TEST(TickText, HasTheDecimalsThatTellTicksApart) {
  EXPECT_EQ("400", TickText(400.0, 200.0));
  EXPECT_EQ("0.2", TickText(0.2, 0.1));
  EXPECT_EQ("-0.05", TickText(-0.05, 0.05));
  EXPECT_EQ("0.0", TickText(-1e-17, 0.5));
}

TEST(GrowingLimit, FollowsUpwardsOnly) {
  GrowingLimit limit(100.0);
  EXPECT_DOUBLE_EQ(100.0, limit.value());
  limit.Include(130.0);
  EXPECT_DOUBLE_EQ(200.0, limit.value());
  limit.Include(3.0);
  limit.Include(std::numeric_limits<double>::quiet_NaN());
  limit.Include(std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(200.0, limit.value());
}

}  // namespace
}  // namespace train_brake_rviz
