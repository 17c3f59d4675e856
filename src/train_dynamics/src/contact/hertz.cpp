#include "train_dynamics/contact/hertz.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/cbrt.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>

namespace train_dynamics {
namespace {

constexpr double kPi = boost::math::constants::pi<double>();

/// K(e) - E(e), the difference in which the load formulas are written.
double EllipticDifference(double e) { return boost::math::ellint_1(e) - boost::math::ellint_2(e); }

/// Ratio of the smaller to the larger relative curvature of an ellipse with this eccentricity.
double CurvatureRatio(double e) {
  return EllipticDifference(e) / (boost::math::ellint_2(e) / (1.0 - e * e) - boost::math::ellint_1(e));
}

/// Eccentricity with the given curvature ratio in (0, 1); the ratio falls monotonically with e.
double Eccentricity(double curvature_ratio) {
  double low = 1e-4, high = 1.0 - 1e-12;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (CurvatureRatio(middle) > curvature_ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

ContactEllipse HertzEllipse(const HertzParams& params, double wheel_radius_m) {
  const double longitudinal = 0.5 / wheel_radius_m;
  const double lateral = 0.5 * (1.0 / params.wheel_lateral_radius_m + 1.0 / params.rail_lateral_radius_m);
  const double small = std::min(longitudinal, lateral);
  const double ratio = small / std::max(longitudinal, lateral);
  const double modulus = params.youngs_modulus_pa / (2.0 * (1.0 - params.poisson_ratio * params.poisson_ratio));

  // Near the circle (K - E) / e^2 tends to pi / 4 and the axes differ by less than e^2 / 2.
  double major_cubed = 3.0 / (8.0 * modulus * small);
  double minor_over_major = 1.0;
  if (ratio < 1.0 - 1e-6) {
    const double e = Eccentricity(ratio);
    major_cubed = 3.0 * EllipticDifference(e) / (2.0 * kPi * modulus * e * e * small);
    minor_over_major = std::sqrt(1.0 - e * e);
  }
  const double major = boost::math::cbrt(major_cubed);
  const double minor = minor_over_major * major;
  return longitudinal <= lateral ? ContactEllipse{major, minor} : ContactEllipse{minor, major};
}

}  // namespace train_dynamics
