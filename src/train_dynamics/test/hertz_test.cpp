#include "train_dynamics/contact/hertz.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);
constexpr double kStaticWheelLoad = 196.3e3;  // [N], physics of the paper's wagon

struct Curvatures {
  double longitudinal, lateral;  // A and B in the gap A x^2 + B y^2 [1/m]
};

// A wheel of these relative curvatures on the paper's steel.
ContactEllipse EllipseOf(const Curvatures& c) {
  HertzParams p = OreWagon().wheel_rail.hertz;
  p.wheel_lateral_radius_m = p.rail_lateral_radius_m = 1.0 / c.lateral;
  return HertzEllipse(p, 0.5 / c.longitudinal);
}

double ContactModulus() {
  const HertzParams& p = OreWagon().wheel_rail.hertz;
  return p.youngs_modulus_pa / (2.0 * (1.0 - p.poisson_ratio * p.poisson_ratio));
}

// Depression of both elastic half spaces at (x, y) under the pressure p0 sqrt(1 - x^2/a^2 - y^2/b^2):
// Boussinesq's integral of p / (pi E* distance) in polar coordinates about (x, y). Along each chord the
// pressure is the root of a parabola, c + 2 g s - h s^2, whose integral is known; over the directions the
// trapezoidal rule converges exponentially because the integrand is periodic.
double Depression(double a, double b, double p0, double x, double y) {
  constexpr int kDirections = 400;
  double sum = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = kPi * i / kDirections;
    const double u = std::cos(angle), v = std::sin(angle);
    const double c = 1.0 - x * x / (a * a) - y * y / (b * b);
    const double g = -(x * u / (a * a) + y * v / (b * b));
    const double h = u * u / (a * a) + v * v / (b * b);
    sum += 0.5 * kPi * (c * h + g * g) / (h * std::sqrt(h));
  }
  return p0 / (kPi * ContactModulus()) * sum * kPi / kDirections;
}

TEST(Hertz, TheDeformedSurfacesTouchAllOverTheEllipse) {
  const HertzParams& steel = OreWagon().wheel_rail.hertz;
  const double wheel = 0.5 / OreWagon().wheelset.wheel_radius_m;
  const double lateral = 0.5 * (1.0 / steel.wheel_lateral_radius_m + 1.0 / steel.rail_lateral_radius_m);
  for (const Curvatures& c : {Curvatures{wheel, lateral}, {1.0, 1.1}, {1.0, 1.00001}, {5.0, 1.0}, {1.0, 40.0}}) {
    const ContactEllipse ellipse = EllipseOf(c);
    for (const double load : {1e3, kStaticWheelLoad, 1e6}) {
      const double a = ellipse.a_per_cbrt_n * std::cbrt(load), b = ellipse.b_per_cbrt_n * std::cbrt(load);
      const double p0 = 3.0 * load / (2.0 * kPi * a * b);  // the pressure's integral is the load
      const double approach = Depression(a, b, p0, 0.0, 0.0);
      for (const auto& [u, v] : {std::array{0.9, 0.0}, {0.0, 0.9}, {0.5, -0.6}, {0.99, 0.1}}) {
        const double x = u * a, y = v * b;
        const double gap = c.longitudinal * x * x + c.lateral * y * y;
        // Where the ellipse is nearly a circle, the eccentricity is found from differences of 1e-6 of numbers
        // known to 1e-16: 1e-9 is what remains; elsewhere it is rounding.
        EXPECT_NEAR(approach - Depression(a, b, p0, x, y), gap, 2e-9 * approach);
      }
    }
  }
}

TEST(Hertz, EqualCurvaturesMakeACircle) {
  const double radius = 0.4;
  const ContactEllipse circle = EllipseOf({0.5 / radius, 0.5 / radius});
  const double closed_form = std::cbrt(3.0 * radius / (4.0 * ContactModulus()));
  EXPECT_NEAR(circle.a_per_cbrt_n, closed_form, 1e-14 * closed_form);  // rounding
  EXPECT_EQ(circle.a_per_cbrt_n, circle.b_per_cbrt_n);
  // Both sides of the circle lead to it: the axes move by about a third of the change in curvature.
  for (const double change : {-2e-6, 2e-6}) {
    const ContactEllipse near = EllipseOf({0.5 / radius, 0.5 / radius * (1.0 + change)});
    EXPECT_NEAR(near.a_per_cbrt_n, closed_form, 2e-6 * closed_form);
    EXPECT_NEAR(near.b_per_cbrt_n, closed_form, 2e-6 * closed_form);
  }
}

TEST(Hertz, AxesSwapWithTheCurvatures) {
  for (const double ratio : {0.02, 0.3, 0.97, 1.7, 30.0}) {
    const ContactEllipse one = EllipseOf({1.0, ratio}), other = EllipseOf({ratio, 1.0});
    EXPECT_NEAR(one.a_per_cbrt_n, other.b_per_cbrt_n, 1e-14 * one.a_per_cbrt_n);  // rounding
    EXPECT_NEAR(one.b_per_cbrt_n, other.a_per_cbrt_n, 1e-14 * one.b_per_cbrt_n);
    EXPECT_EQ(one.a_per_cbrt_n > one.b_per_cbrt_n,
              ratio > 1.0);  // the longer axis along the smaller curvature
  }
}

TEST(Hertz, NumbersOfThePapersWheel) {
  const VehicleParams& p = OreWagon();
  const ContactEllipse ellipse = HertzEllipse(p.wheel_rail.hertz, p.wheelset.wheel_radius_m);
  const double a = ellipse.a_per_cbrt_n * std::cbrt(kStaticWheelLoad);
  const double b = ellipse.b_per_cbrt_n * std::cbrt(kStaticWheelLoad);
  // Half a unit of the last digit given in the project's notes.
  EXPECT_NEAR(a, 10.24e-3, 0.005e-3);
  EXPECT_NEAR(b, 4.41e-3, 0.005e-3);
  EXPECT_NEAR(1.5 * kStaticWheelLoad / (kPi * a * b), 2.08e9, 0.005e9);
}

}  // namespace
}  // namespace train_dynamics
