#include "train_dynamics/track/dip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "strict_config/validate.h"
#include "train_dynamics/track/track.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

TEST(Dip, IsEq7) {
  const DipParams dip{40.0, 0.0512, 10.0};
  for (double x = 0.0; x <= 10.0; x += 0.1) {
    // Accuracy of the cosine, 2e-16, times the depth.
    EXPECT_NEAR(DipHeight(dip, 40.0 + x).height, -0.0256 * (1.0 - std::cos(2.0 * kPi * x / 10.0)), 1e-16);
  }
  EXPECT_NEAR(DipHeight(dip, 45.0).height, -0.0512, 1e-17);  // positive depth is down
}

TEST(Dip, SlopeIsTheDerivativeAndBothVanishOutside) {
  const DipParams dip{-3.0, 0.03, 7.0};
  constexpr double kStep = 1e-4;
  for (double x = -4.03; x < 5.0; x += 0.05) {
    const double difference = (DipHeight(dip, x + kStep).height - DipHeight(dip, x - kStep).height) / (2.0 * kStep);
    // h^2/6 times the third derivative, 0.011 1/m^2; across an end h/4 times the jump of the second, 0.012
    // 1/m.
    EXPECT_NEAR(DipHeight(dip, x).slope, difference, 3e-7) << x;
  }
  for (const double x : {-100.0, -3.0, 4.0, 100.0}) {
    EXPECT_EQ(DipHeight(dip, x).height, 0.0);
    EXPECT_EQ(DipHeight(dip, x).slope, 0.0);
  }
}

TEST(Dip, OverlappingDipsAddUp) {
  TrackParams track;
  track.dips = {{0.0, 0.05, 10.0}, {4.0, -0.02, 8.0}};
  for (const double x : {2.0, 5.0, 9.0, 11.0}) {
    const RailHeight<double> one = DipHeight(track.dips[0], x), other = DipHeight(track.dips[1], x);
    EXPECT_EQ(RailHeightAt(track, x).height, one.height + other.height);
    EXPECT_EQ(RailHeightUnder<double>(track, x).slope, one.slope + other.slope);
  }
}

}  // namespace
}  // namespace train_dynamics
