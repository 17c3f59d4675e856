#include "train_dynamics/numeric/trigonometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

TEST(Trigonometry, AgreesWithTheLibrary) {
  for (double turns = -3.0; turns < 3.0; turns += 0.000731) {
    const SinCos sc = SinCosTurns(turns);
    const long double angle = 2.0L * std::acos(-1.0L) * turns;
    // The documented 2e-16, and half an ulp of 2 pi for the angle itself.
    EXPECT_NEAR(sc.sin, static_cast<double>(std::sin(angle)), 3e-16);
    EXPECT_NEAR(sc.cos, static_cast<double>(std::cos(angle)), 3e-16);
  }
  EXPECT_NEAR(SinCosDegrees(22.0).sin, std::sin(22.0 * kPi / 180.0), 3e-16);
}

TEST(Trigonometry, IsExactAtQuarterTurns) {
  for (int turn = -2; turn <= 2; ++turn) {
    EXPECT_EQ(SinCosTurns(turn).sin, 0.0);
    EXPECT_EQ(SinCosTurns(turn).cos, 1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.25).sin, 1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.25).cos, 0.0);
    EXPECT_EQ(SinCosTurns(turn + 0.5).cos, -1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.75).sin, -1.0);
  }
}

}  // namespace
}  // namespace train_dynamics
