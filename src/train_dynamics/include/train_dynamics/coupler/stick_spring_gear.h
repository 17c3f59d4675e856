#pragma once

#include "train_dynamics/coupler/damped_stick_gear.h"

namespace train_dynamics {

/// Force of a connection whose friction sticks: rate-independent in direction, with memory.
///
///   F_n = clamp(F_(n-1) + k_stick (q_n - q_(n-1)), unloading branch, loading branch)
///   branches: F_s tan(phi) / (tan(phi) +- mu),  mu = mu_k + (mu_s - mu_k) exp(-|w| / v_s)
///
/// With mu_s = mu_k the path of the force depends on the path of q alone, not on its speed. With a steep drop
/// from static to kinetic friction a long train becomes CHAOTIC: a start speed changed by 1e-10 km/h moves
/// later peaks by tens of kN. Study such trains statistically and never compare them point by point.
template <class T>
GearForce<T> StickSpringGearForce(const DraftGear& gear, T q, T q_rate, StickState<T>& state) {
  const DraftGearParams& p = gear.params;
  const T travel = GearTravel(p, q);
  const T spring = GearSpringForce(p, travel);
  const T mu = GearFrictionCoefficient(p, T(0.5) * q_rate);
  const T loading = spring * gear.tan_wedge / (gear.tan_wedge - mu);
  const T unloading = spring * gear.tan_wedge / (gear.tan_wedge + mu);
  const T lower = Select(q < T(0.0), -loading, unloading);
  const T upper = Select(q < T(0.0), -unloading, loading);
  state.force = Clamp(state.force + p.stick_stiffness_n_per_m * (q - state.q), lower, upper);
  state.q = q;
  const T stop = GearStopForce(p, travel);
  return {state.force + CopySign(stop, q), CopySign(spring + stop, q)};
}

/// Two draft gears with stick-spring friction, as a law of connections.
struct StickSpringGears : DraftGear {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  template <class T>
  using Memory = StickState<T>;
  static constexpr bool kStoresByMemory = true;
  static constexpr bool kRateIndependent = false;

  explicit StickSpringGears(const DraftGearParams& gear) : DraftGear(gear), device(gear) {
    device.stick_stiffness_n_per_m = 2.0 * gear.stick_stiffness_n_per_m;  // of one of two in series
  }
  template <class T>
  StickState<T> AtRest(T q) const {
    return {q, T(0.0)};
  }
  double Slack() const { return params.slack_m; }
  /// While it sticks.
  ConnectionTangent TangentAt(double /*force_n*/) const { return {params.stick_stiffness_n_per_m, 0.0, false}; }

  FrictionDevice device;  ///< a gear with mu_k
};

template <class T>
GearForce<T> ConnectionForce(const StickSpringGears& gears, T q, T q_rate, StickState<T>& memory) {
  return StickSpringGearForce(gears, q, q_rate, memory);
}

/// Energy that would be recovered with mu_k, the least friction. The energy that the spring of a slow gear exchanges
/// below that branch is not counted: single steps may book less than zero, closed paths do not.
template <class T>
T StoredEnergy(const StickSpringGears& gears, T q, const StickState<T>& memory) {
  const T travel = GearTravel(gears.params, q);
  const T along = CopySign(T(1.0), q);
  const T force = Clamp((memory.force + gears.params.stick_stiffness_n_per_m * (q - memory.q)) * along,
                        gears.device.Unloading(travel), gears.device.Loading(travel));
  return 2.0 * RecoverableEnergy(gears.device, travel, force);
}

}  // namespace train_dynamics
