#pragma once

#include <type_traits>

#include "train_dynamics/contact/adhesion.h"
#include "train_dynamics/contact/hertz.h"
#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

/// Stiffness of the creep law per N^(2/3): G pi a b c11 / 4 = creep_stiffness N^(2/3) [N].
/// @param shear_modulus_pa  G; the paper's appendix calls its value "shear strength".
double CreepStiffness(const ContactEllipse& ellipse, double shear_modulus_pa, double kalker_c11);

/// Parameters of the rail's surface in the creep law besides mu0, in the symbols of AdhesionParams.
///
/// P is double where all lanes of a T are on the same surface, else T: the bits are the same.
template <class P>
struct CreepShape {
  P friction_ratio, friction_decay, adhesion_reduction, slip_reduction;
};

/// The creep law of one wheelset (two equal wheels), frozen for a time step: all but the slip speed.
template <class T, class P = double>
struct CreepLaw : CreepShape<P> {
  T friction_limit;  ///< N mu0 of both wheels [N]
  T steepness;       ///< eps per slip speed for mu = mu0 [s/m]
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
template <class T, class P>
CreepLaw<T, P> FreezeCreepLaw(const CreepShape<P>& shape, double creep_stiffness, const T& normal_force,
                              const T& friction, const T& speed, double regularisation) {
  const T per_wheel = Max(T(1.0), 0.5 * normal_force);  // below 1 N the limit, not the steepness, decides
  const T reference_speed = Sqrt(speed * speed + regularisation * regularisation);
  return {shape, normal_force * friction, creep_stiffness * InverseCbrt(per_wheel) / (friction * reference_speed)};
}

/// The same on one surface, whose own mu0 `friction` replaces.
template <class T>
CreepLaw<T> FreezeCreepLaw(const AdhesionParams& adhesion, double creep_stiffness, T normal_force, T friction, T speed,
                           double regularisation) {
  const CreepShape<double> shape{adhesion.friction_ratio, adhesion.friction_decay_s_per_m, adhesion.adhesion_reduction,
                                 adhesion.slip_reduction};
  return FreezeCreepLaw<T, double>(shape, creep_stiffness, normal_force, friction, speed, regularisation);
}

/// Longitudinal creep force of a wheelset and its slope, for a slip speed w >= 0.
///
///   mu(w) = mu0 [(1 - A) exp(-B w) + A],   eps = steepness w mu0 / mu
///   F     = (2 N mu / pi) [ kA eps / (1 + (kA eps)^2) + atan(kS eps) ]
///
/// The force is odd in w: the caller gives |w| and restores the sign; it opposes the slip. |F| <= N mu0.
/// Small-slip slope: (kA + kS) (2/pi) N mu0 steepness = (kA + kS) G a b c11 / v_ref for both wheels.
/// Source: Polach, Wear 258 (2005) 992-1000; the paper's reference [34].
template <class T, class P>
CreepForce<T> PolachForce(const CreepLaw<T, P>& law, const T& slip_speed) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  const P ka = law.adhesion_reduction, ks = law.slip_reduction;
  T relative_friction(1.0), relative_friction_slope(0.0);  // mu / mu0 and its derivative over w
  T eps = law.steepness * slip_speed;
  T eps_slope = law.steepness;
  const MaskOf<P> falls = law.friction_decay > P(0.0);
  if (AnyOf(falls)) {
    const T falling = (1.0 - law.friction_ratio) * Exp(-law.friction_decay * slip_speed);
    relative_friction = falling + law.friction_ratio;
    relative_friction_slope = -law.friction_decay * falling;
    if constexpr (!std::is_same_v<P, double>) {  // where it does not fall, mu / mu0 is 1 to the last bit
      relative_friction = Select(falls, relative_friction, T(1.0));
      relative_friction_slope = Select(falls, relative_friction_slope, T(0.0));
    }
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
