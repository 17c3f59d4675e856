#pragma once

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Propulsion resistance of a vehicle (paper Eq 5), in newtons per kilonewton of its weight: RollingResistance +
/// AirDrag.
struct PropulsionResistanceParams {
  double constant_n_per_kn = kRequired;        ///< a
  double linear_n_per_kn_kmh = kRequired;      ///< b
  double quadratic_n_per_kn_kmh2 = kRequired;  ///< c, aerodynamic

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("constant_n_per_kn", constant_n_per_kn, kNonNegative);
    v.Number("linear_n_per_kn_kmh", linear_n_per_kn_kmh, kNonNegative);
    v.Number("quadratic_n_per_kn_kmh2", quadratic_n_per_kn_kmh2, kNonNegative);
  }
};

/// Resistance that arises at wheels and bearings [N], even in the speed; opposes motion, set-valued at rest.
///
///   R_w = W (a + b v) / 1000,  v in km/h, W the weight [N]   (the first two terms of paper Eq 5)
template <class T>
T RollingResistance(const PropulsionResistanceParams& p, double weight_n, T speed) {
  const double weight_kn = 1e-3 * weight_n;
  return weight_kn * (p.constant_n_per_kn + p.linear_n_per_kn_kmh * (3.6 * Abs(speed)));
}

/// Drag of the air [N], even in the speed; opposes motion and vanishes at rest.
///
///   R_a = W c v^2 / 1000,  v in km/h, W the weight [N]   (the third term of paper Eq 5)
template <class T>
T AirDrag(const PropulsionResistanceParams& p, double weight_n, T speed) {
  const double weight_kn = 1e-3 * weight_n;
  const T v_kmh = 3.6 * speed;
  return weight_kn * p.quadratic_n_per_kn_kmh2 * (v_kmh * v_kmh);
}

}  // namespace train_dynamics
