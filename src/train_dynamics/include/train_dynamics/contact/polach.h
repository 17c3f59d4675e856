#pragma once

#include "train_dynamics/contact/hertz.h"
#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Adhesion of a rail surface in Polach's model.
struct AdhesionParams {
  double friction_coefficient = kRequired;  ///< mu0, at zero slip speed; the track may override it
  double friction_ratio = 1.0;              ///< A = mu(infinite slip) / mu0
  double friction_decay_s_per_m = 0.0;      ///< B
  double adhesion_reduction = 1.0;          ///< kA, in the area of adhesion
  double slip_reduction = 1.0;              ///< kS, in the area of slip

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false});
    v.Number("friction_ratio", friction_ratio, Range{0.0, 1.0, true, false});
    v.Number("friction_decay_s_per_m", friction_decay_s_per_m, kNonNegative);
    v.Number("adhesion_reduction", adhesion_reduction, Range{0.0, 1.0, true, false});
    v.Number("slip_reduction", slip_reduction, Range{0.0, 1.0, true, false});
    v.Check(slip_reduction <= adhesion_reduction, "slip_reduction", "must be at most adhesion_reduction");
  }
};

/// Stiffness of the creep law per N^(2/3): G pi a b c11 / 4 = creep_stiffness N^(2/3) [N].
/// @param shear_modulus_pa  G; the paper's appendix calls its value "shear strength".
double CreepStiffness(const ContactEllipse& ellipse, double shear_modulus_pa, double kalker_c11);

/// The creep law of one wheelset (two equal wheels), frozen for a time step: all but the slip speed.
template <class T>
struct CreepLaw {
  T friction_limit;  ///< N mu0 of both wheels [N]
  T steepness;       ///< eps per slip speed for mu = mu0 [s/m]
  double friction_ratio, friction_decay, adhesion_reduction, slip_reduction;
};

/// A creep force [N] and its slope over the slip speed [Ns/m].
template <class T>
struct CreepForce {
  T force, slope;
};

/// Freezes the creep law of a wheelset.
///
///   eps = G pi a b c11 |s| / (4 Q mu),  s = w / v_ref,  v_ref = sqrt(v^2 + v0^2),  Q = N/2 per wheel
///
/// @param creep_stiffness  see CreepStiffness [N^(1/3)]
/// @param normal_force     N of both wheels [N], >= 0; zero gives no creep force
/// @param friction         mu0 at the wheel [-]
/// @param speed            v of the wheelset [m/s], either sign
/// @param regularisation   v0 [m/s]: keeps the creepage finite at standstill
template <class T>
CreepLaw<T> FreezeCreepLaw(const AdhesionParams& adhesion, double creep_stiffness, T normal_force, T friction,
                           T speed, double regularisation) {
  const T per_wheel = Max(T(1.0), 0.5 * normal_force);  // below 1 N the limit, not the steepness, decides
  const T reference_speed = Sqrt(speed * speed + regularisation * regularisation);
  return {
      normal_force * friction,     creep_stiffness * InverseCbrt(per_wheel) / (friction * reference_speed),
      adhesion.friction_ratio,     adhesion.friction_decay_s_per_m,
      adhesion.adhesion_reduction, adhesion.slip_reduction};
}

/// Longitudinal creep force of a wheelset and its slope, for a slip speed w >= 0.
///
///   mu(w) = mu0 [(1 - A) exp(-B w) + A],   eps = steepness w mu0 / mu
///   F     = (2 N mu / pi) [ kA eps / (1 + (kA eps)^2) + atan(kS eps) ]
///
/// The force is odd in w: the caller gives |w| and restores the sign; it opposes the slip. |F| <= N mu0.
/// Small-slip slope: (kA + kS) (2/pi) N mu0 steepness = (kA + kS) G a b c11 / v_ref for both wheels.
/// Source: Polach, Wear 258 (2005) 992-1000; the paper's reference [34].
template <class T>
CreepForce<T> PolachForce(const CreepLaw<T>& law, T slip_speed) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  const double ka = law.adhesion_reduction, ks = law.slip_reduction;
  T relative_friction(1.0), relative_friction_slope(0.0);  // mu / mu0 and its derivative over w
  T eps = law.steepness * slip_speed;
  T eps_slope = law.steepness;
  if (law.friction_decay > 0.0) {
    const T falling = (1.0 - law.friction_ratio) * Exp(-law.friction_decay * slip_speed);
    relative_friction = falling + law.friction_ratio;
    relative_friction_slope = -law.friction_decay * falling;
    eps = eps / relative_friction;
    eps_slope = (eps_slope - eps * relative_friction_slope) / relative_friction;
  }
  const T adhesion = ka * eps;
  const T adhesion_inv = 1.0 / (1.0 + adhesion * adhesion);
  const T slip = ks * eps;
  const T saturation = adhesion * adhesion_inv + Atan(slip);
  const T saturation_slope =
      ka * (1.0 - adhesion * adhesion) * (adhesion_inv * adhesion_inv) + ks / (1.0 + slip * slip);
  const T scale = kTwoOverPi * law.friction_limit;
  return {scale * relative_friction * saturation,
          scale * (relative_friction_slope * saturation + relative_friction * saturation_slope * eps_slope)};
}

}  // namespace train_dynamics
