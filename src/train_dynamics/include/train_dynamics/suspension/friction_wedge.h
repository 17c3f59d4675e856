#pragma once

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// One friction wedge of a three-piece bogie, between the slope of the bolster and the column of the frame.
struct FrictionWedgeParams {
  double outer_stiffness_n_per_m = kRequired;
  double inner_stiffness_n_per_m = kRequired;
  double stage1_travel_m = kRequired;
  double wedge_angle_deg = kRequired;
  double toe_angle_deg = kRequired;
  double static_friction_coefficient = kRequired;
  double kinetic_friction_coefficient = kRequired;
  double blend_speed_mps = kRequired;
  double offset_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("outer_stiffness_n_per_m", outer_stiffness_n_per_m, kPositive, "stiffness of the spring under the wedge");
    v.Number("inner_stiffness_n_per_m", inner_stiffness_n_per_m, kNonNegative,
             "stiffness of its inner spring; 0: none");
    v.Number("stage1_travel_m", stage1_travel_m, kNonNegative,
             "travel of the wedge at which the inner spring takes load");
    v.Number("wedge_angle_deg", wedge_angle_deg, Range{0.0, 90.0},
             "alpha, angle of the bolster's slope to the vertical");
    v.Number("toe_angle_deg", toe_angle_deg, Range{-20.0, 20.0, false, false},
             "gamma, angle of the column to the vertical, toe-out positive");
    v.Number("static_friction_coefficient", static_friction_coefficient, Range{0.0, 1.0, false, true},
             "static friction on both surfaces");
    v.Number("kinetic_friction_coefficient", kinetic_friction_coefficient, Range{0.0, 1.0, false, true},
             "kinetic friction on both surfaces");
    v.Number("blend_speed_mps", blend_speed_mps, kPositive,
             "sliding speed at which half of the drop from static to kinetic friction has happened");
    v.Number("offset_m", offset_m, kPositive, "distance of the wedges before and behind the bolster's centre");
    v.Check(kinetic_friction_coefficient <= static_friction_coefficient, "kinetic_friction_coefficient",
            "must be at most static_friction_coefficient");
  }
};

/// A friction wedge without inertia: what is constant in it.
///
/// Eq 6 of the paper (corrected) with m_w = 0 leaves the vertical force on the bolster as a fraction R of the
/// wedge spring's force. With the friction coefficient mu = tan(phi) on both surfaces, phi > 0 while loading:
///
///   R(mu) = sin(alpha + phi) cos(gamma - phi) / sin(alpha + gamma)
///         = (sin a + mu cos a)(cos g + mu sin g) / ((1 + mu^2) sin(a + g))
///
/// R(0) = kappa is at once the kinematic ratio of wedge travel to bolster travel, so that the elastic part is
/// conservative. Friction is what R adds or takes away: R(mu) - R(0) up while the bolster comes down
/// (loading), R(0) - R(-mu) down while it rises; any value between when it sticks. Left out: the 6 kg wedge's
/// inertia.
struct FrictionWedge {
  explicit FrictionWedge(const FrictionWedgeParams& params);

  FrictionWedgeParams params;
  double sin_wedge, cos_wedge, sin_toe, cos_toe;  ///< of alpha and gamma
  double inv_sin_sum;                             ///< 1 / sin(alpha + gamma)
  double kappa;                                   ///< wedge travel per bolster travel, R(0)

  /// R(mu); mu > 0 loading, < 0 unloading.
  template <class T>
  T ForceRatio(T mu) const {
    return (sin_wedge + mu * cos_wedge) * (cos_toe + mu * sin_toe) * inv_sin_sum / (1.0 + mu * mu);
  }
};

/// Force of one wedge's springs along the wedge's travel [N], >= 0.
/// @param travel  kappa times the compression between bolster and frame at the wedge [m]
template <class T>
T WedgeSpringForce(const FrictionWedgeParams& p, T travel) {
  return p.outer_stiffness_n_per_m * Max(T(0.0), travel) +
         p.inner_stiffness_n_per_m * Max(T(0.0), travel - p.stage1_travel_m);
}

/// Elastic energy of one wedge's springs [J].
template <class T>
T WedgeSpringEnergy(const FrictionWedgeParams& p, T travel) {
  const T outer = Max(T(0.0), travel);
  const T inner = Max(T(0.0), travel - p.stage1_travel_m);
  return 0.5 * (p.outer_stiffness_n_per_m * outer * outer + p.inner_stiffness_n_per_m * inner * inner);
}

/// Bounds of the vertical friction force of one wedge on the bolster [N], upwards positive.
template <class T>
struct WedgeFrictionBounds {
  T lower;  ///< <= 0, reached while the bolster rises
  T upper;  ///< >= 0, reached while the bolster comes down
};

/// Friction bounds of one wedge at the present spring force and rate.
///
///   mu(u) = mu_k + (mu_s - mu_k) / (1 + (u / u_blend)^2)
///
/// @param spring_force  WedgeSpringForce [N]
/// @param rate          u, vertical rate of the bolster relative to the frame [m/s]; only its size matters
template <class T>
WedgeFrictionBounds<T> WedgeFriction(const FrictionWedge& wedge, T spring_force, T rate) {
  const FrictionWedgeParams& p = wedge.params;
  const T relative_rate = rate * (1.0 / p.blend_speed_mps);
  const T mu = p.kinetic_friction_coefficient +
               (p.static_friction_coefficient - p.kinetic_friction_coefficient) / (1.0 + relative_rate * relative_rate);
  return {spring_force * (wedge.ForceRatio(-mu) - wedge.kappa), spring_force * (wedge.ForceRatio(mu) - wedge.kappa)};
}

}  // namespace train_dynamics
