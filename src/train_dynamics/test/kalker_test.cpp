#include "train_dynamics/contact/kalker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "paper_vehicle.h"
#include "train_dynamics/contact/hertz.h"

namespace train_dynamics {
namespace {

TEST(Kalker, ReproducesHisTable) {
  // Kalker's published c11; a/b = 0.1 ... 1, then b/a = 0.9 ... 0.1.
  const std::array<double, 3> poisson = {0.0, 0.25, 0.5};
  const std::array<std::vector<double>, 3> slim = {{{2.51, 2.59, 2.68, 2.78, 2.88, 2.98, 3.09, 3.19, 3.29, 3.40},
                                                    {3.31, 3.37, 3.44, 3.53, 3.62, 3.72, 3.81, 3.91, 4.01, 4.12},
                                                    {4.85, 4.81, 4.80, 4.82, 4.83, 4.91, 4.97, 5.05, 5.12, 5.20}}};
  const std::array<std::vector<double>, 3> long_ones = {{{3.51, 3.65, 3.82, 4.06, 4.37, 4.84, 5.57, 6.96, 10.7},
                                                         {4.22, 4.36, 4.54, 4.78, 5.10, 5.57, 6.34, 7.78, 11.7},
                                                         {5.30, 5.42, 5.58, 5.80, 6.11, 6.57, 7.34, 8.82, 12.9}}};
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 10; ++i) {
      EXPECT_NEAR(KalkerC11((i + 1) / 10.0, poisson[row]), slim[row][i], 1e-12);  // rounding of the abscissa
    }
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(KalkerC11(10.0 / (9 - i), poisson[row]), long_ones[row][i], 1e-12);
    }
  }
}

TEST(Kalker, InterpolatesBetweenNeighboursAndSmoothlyThroughTheCircle) {
  for (double ratio = 0.101; ratio < 0.999; ratio += 0.0137) {
    const double below = KalkerC11(std::floor(10.0 * ratio) / 10.0, 0.0);
    const double above = KalkerC11(std::ceil(10.0 * ratio) / 10.0, 0.0);
    EXPECT_GE(KalkerC11(ratio, 0.0), below);
    EXPECT_LE(KalkerC11(ratio, 0.0), above);
  }
  const double h = 1e-6;
  const double at = KalkerC11(1.0, 0.3);
  const double slope_before = (at - KalkerC11(1.0 - h, 0.3)) / h, slope_after = (KalkerC11(1.0 + h, 0.3) - at) / h;
  // One-sided differences err by h times the curvature, about 10, beside rounding of 1e-15 / h.
  EXPECT_NEAR(slope_before, slope_after, 1e-4);
}

TEST(Kalker, ValueOfThePapersWheel) {
  const VehicleParams& p = OreWagon();
  const ContactEllipse e = HertzEllipse(p.wheel_rail.hertz, p.wheelset.wheel_radius_m);
  // The notes give three digits.
  EXPECT_NEAR(KalkerC11(e.a_per_cbrt_n / e.b_per_cbrt_n, p.wheel_rail.hertz.poisson_ratio), 5.70, 0.005);
}

TEST(Kalker, RefusesWhatTheTableDoesNotHold) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double ratio : {0.0, 0.0999, 10.001, -1.0, nan}) EXPECT_THROW(KalkerC11(ratio, 0.3), std::domain_error);
  for (const double poisson : {-0.001, 0.5001, nan}) EXPECT_THROW(KalkerC11(1.0, poisson), std::domain_error);
  EXPECT_NO_THROW(KalkerC11(0.1, 0.0));
  EXPECT_NO_THROW(KalkerC11(10.0, 0.5));
}

}  // namespace
}  // namespace train_dynamics
