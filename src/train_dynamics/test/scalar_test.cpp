#include "train_dynamics/numeric/scalar.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/lanes.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Scalar, MaxAndMinKeepTheSecondOperandWhereNothingIsGreater) {
  static_assert(Max(1.0, 2.0) == 2.0 && Max(2.0, 1.0) == 2.0 && Min(1.0, 2.0) == 1.0);
  EXPECT_TRUE(std::isnan(Max(0.0, kNaN)));
  EXPECT_TRUE(std::isnan(Min(0.0, kNaN)));
  EXPECT_EQ(Max(kNaN, 0.0), 0.0);
  EXPECT_EQ(Min(kNaN, 0.0), 0.0);
  EXPECT_TRUE(std::signbit(Max(0.0, -0.0)));
  EXPECT_FALSE(std::signbit(Min(-0.0, 0.0)));
}

TEST(Scalar, ClampKeepsNaN) {
  static_assert(Clamp(-3.0, -1.0, 2.0) == -1.0 && Clamp(3.0, -1.0, 2.0) == 2.0 && Clamp(0.5, -1.0, 2.0) == 0.5);
  EXPECT_EQ(Clamp(kInfinity, -1.0, 2.0), 2.0);
  EXPECT_TRUE(std::isnan(Clamp(kNaN, -1.0, 2.0)));
}

TEST(Scalar, SignsAndBits) {
  static_assert(CopySign(3.0, -0.0) == -3.0 && CopySign(-3.0, 2.0) == 3.0 && Abs(-3.0) == 3.0);
  static_assert(ToBits(1.0) == 0x3ff0000000000000 && FromBits(ToBits(-0.1)) == -0.1);
  EXPECT_FALSE(std::signbit(Abs(-0.0)));
  EXPECT_TRUE(std::isnan(Abs(kNaN)));
  EXPECT_TRUE(std::isnan(Sqrt(-1.0)));
}

}  // namespace
}  // namespace train_dynamics
