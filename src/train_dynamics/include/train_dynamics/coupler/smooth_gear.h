#pragma once

#include "train_dynamics/coupler/draft_gear.h"

namespace train_dynamics {

/// Force of a connection with smooth friction (paper Eq 4).
///
///   e = max(|q| - slack/2, 0),  d = e/2,  w = sign(q) q'/2
///   F = sign(q) [ F_s(d) tan(phi) / (tan(phi) - mu(w) tanh(w / v_e)) + F_stop(d) ]
///
/// Loading (w > 0) gives a larger force than the spring's, unloading a smaller one, so that (F - F_elastic)
/// q' >= 0: the gear only dissipates. Continuous in q and q'; it has no true stick: a standing connection
/// settles at its spring force. v_e must stay above 2 F_s mu_s dt / (tan(phi) m), about 9 mm/s at 900 kN, 1
/// ms and 160 t.
///
/// @param q       extension relative to the unstretched length [m], tension positive; the slack is +-slack/2
/// @param q_rate  its rate [m/s]
template <class T>
GearForce<T> SmoothGearForce(const DraftGear& gear, T q, T q_rate) {
  const DraftGearParams& p = gear.params;
  const T travel = GearTravel(p, q);
  if (AllOf(travel == T(0.0))) return {CopySign(T(0.0), q), CopySign(T(0.0), q)};  // in the slack, for all lanes
  const T rate = CopySign(T(0.5), q) * q_rate;
  const T speed = Abs(rate);
  // tanh(w / v_e) = sign(w) (1 - f) / (1 + f), f = e^(-2 |w| / v_e): both sides of the fraction times (1 + f).
  const T faded = Decay(speed * (2.0 / p.smoothing_speed_mps));
  const T mu = p.kinetic_friction_coefficient + (p.static_friction_coefficient - p.kinetic_friction_coefficient) *
                                                    Decay(speed * (1.0 / p.stribeck_speed_mps));
  const T spring = GearSpringForce(p, travel);
  const T wedge = gear.tan_wedge * (1.0 + faded);
  const T with_friction = spring * wedge / (wedge - CopySign(mu * (1.0 - faded), rate));
  const T stop = GearStopForce(p, travel);
  return {CopySign(with_friction + stop, q), CopySign(spring + stop, q)};
}

/// Two draft gears with smooth friction, as a law of connections.
struct SmoothGears : DraftGear {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  template <class T>
  using Memory = NoMemory<T>;
  static constexpr bool kStoresByMemory = false;

  using DraftGear::DraftGear;
  template <class T>
  NoMemory<T> AtRest(T /*q*/) const {
    return {};
  }
  double Slack() const { return params.slack_m; }
  /// k_s / 2 of the two springs, and F mu_s / (2 tan(phi) v_e), the slope of the friction at rest.
  ConnectionTangent TangentAt(double force_n) const {
    const double damping =
        force_n * params.static_friction_coefficient / (2.0 * tan_wedge * params.smoothing_speed_mps);
    return {0.5 * params.spring_stiffness_n_per_m, damping, true};
  }
  /// The least v_e with which the friction does not chatter [m/s]: 2 F mu_s dt / (tan(phi) m).
  double LeastSmoothingSpeed(double force_n, double dt_s, double vehicle_kg) const {
    return 2.0 * force_n * params.static_friction_coefficient * dt_s / (tan_wedge * vehicle_kg);
  }
};

template <class T>
GearForce<T> ConnectionForce(const SmoothGears& gears, T q, T q_rate, NoMemory<T>& /*memory*/) {
  return SmoothGearForce(gears, q, q_rate);
}

template <class T>
T StoredEnergy(const SmoothGears& gears, T q, const NoMemory<T>& /*memory*/) {
  return GearEnergy(gears.params, q);
}

}  // namespace train_dynamics
