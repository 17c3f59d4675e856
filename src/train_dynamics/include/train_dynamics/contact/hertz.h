#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Elastic constants and lateral radii of wheel and rail at the contact point.
struct HertzParams {
  double youngs_modulus_pa = kRequired;
  double poisson_ratio = kRequired;
  double wheel_lateral_radius_m = kRequired;
  double rail_lateral_radius_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("youngs_modulus_pa", youngs_modulus_pa, kPositive, "Young's modulus of wheel and rail");
    v.Number("poisson_ratio", poisson_ratio, Range{0.0, 0.5, false, false}, "Poisson's ratio of wheel and rail");
    v.Number("wheel_lateral_radius_m", wheel_lateral_radius_m, kFinite,
             "lateral radius of the wheel profile at the contact; negative: concave");
    v.Number("rail_lateral_radius_m", rail_lateral_radius_m, kPositive,
             "lateral radius of the rail head at the contact; positive: convex");
    v.Check(wheel_lateral_radius_m != 0.0, "wheel_lateral_radius_m", "must not be 0", {"wheel_lateral_radius_m"});
    v.Check(wheel_lateral_radius_m == 0.0 || 1.0 / wheel_lateral_radius_m + 1.0 / rail_lateral_radius_m > 0.0,
            "wheel_lateral_radius_m",
            "must make a point contact: a concave wheel needs a radius larger than rail_lateral_radius_m",
            {"rail_lateral_radius_m"});
  }
};

/// Contact ellipse per unit of load: all lengths grow with the cube root of the normal force.
///
///   a = a_per_cbrt_n N^(1/3),  b = b_per_cbrt_n N^(1/3),  p0 = 3 N / (2 pi a b)
struct ContactEllipse {
  double a_per_cbrt_n = 0.0;  ///< longitudinal semi-axis [m / N^(1/3)]
  double b_per_cbrt_n = 0.0;  ///< lateral semi-axis [m / N^(1/3)]
};

/// Hertz's contact ellipse of a wheel of rolling radius r on a straight rail.
///
/// With the relative curvatures A = 1/(2 r) (longitudinal) and B = (1/R_wheel + 1/R_rail)/2 (lateral),
/// E* = E / (2 (1 - nu^2)), K and E the complete elliptic integrals of e^2 = 1 - (minor/major)^2:
///
///   small/large curvature = (K - E) / (E major^2/minor^2 - K)       gives e
///   major^3 = 3 N (K - E) / (2 pi E* e^2 small)                       gives the axes
///
/// The longer axis lies along the smaller curvature. Constant curvatures: the wheelset stays centred.
/// Source: Johnson, Contact Mechanics, section 4.2.
ContactEllipse HertzEllipse(const HertzParams& params, double wheel_radius_m);

}  // namespace train_dynamics
