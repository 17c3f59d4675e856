#pragma once

#include "train_dynamics/coupler/draft_gear.h"

namespace train_dynamics {

/// Memory of a connection with LuGre friction.
template <class T>
struct LuGreState {
  T q;  ///< extension at the last evaluation [m]
  T m;  ///< friction coefficient with its sign, loading positive

  template <class Function>
  void ForEachField(Function&& field) {
    field(q);
    field(m);
  }
};

/// Two draft gears whose coefficient of friction follows the sliding over a length: a study of the paper's conclusion
/// 4, no draft gear for real trains.
///
///   m <- s mu(w) + (m - s mu(w)) exp(-|dd| / ell),   F = sign(q) [ F_s t / (t - m) + F_stop ]
///
/// dd step of a gear's travel, s its sign, mu(w) of GearFrictionCoefficient. The friction has no elastic range:
/// vibration lets a loaded gear creep, and with the paper's fall from 0.33 to 0.05 a train is chaotic. F - F_spring is
/// booked as dissipation, which while it slides back over ell is less than zero.
struct LuGreGears : DraftGear {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  static constexpr bool kStoresByMemory = false;
  template <class T>
  using Memory = LuGreState<T>;

  using DraftGear::DraftGear;
  double Slack() const { return params.slack_m; }
  template <class T>
  LuGreState<T> AtRest(T q) const {
    return {q, T(0.0)};
  }
  /// The spring, and the friction that builds up over ell.
  ConnectionTangent TangentAt(double force_n) const {
    const double friction = force_n * params.static_friction_coefficient /
                            (tan_wedge - params.static_friction_coefficient) / params.friction_length_m;
    return {0.5 * (params.spring_stiffness_n_per_m + friction), 0.0, true};
  }
};

template <class T>
GearForce<T> ConnectionForce(const LuGreGears& gears, T q, T q_rate, LuGreState<T>& memory) {
  const DraftGearParams& p = gears.params;
  const T travel = GearTravel(p, q);
  const T step = travel - GearTravel(p, memory.q);
  const T goal = CopySign(GearFrictionCoefficient(p, T(0.5) * q_rate), step);
  memory.m = goal + (memory.m - goal) * Exp(Abs(step) * (-1.0 / p.friction_length_m));
  memory.q = q;
  const T spring = GearSpringForce(p, travel);
  const T stop = GearStopForce(p, travel);
  return {CopySign(spring * gears.tan_wedge / (gears.tan_wedge - memory.m) + stop, q), CopySign(spring + stop, q)};
}

template <class T>
T StoredEnergy(const LuGreGears& gears, T q, const LuGreState<T>& /*memory*/) {
  return GearEnergy(gears.params, q);
}

}  // namespace train_dynamics
