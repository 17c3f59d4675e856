#pragma once

#include "train_dynamics/coupler/connection_law.h"
#include "train_dynamics/spring/linear_spring_damper.h"

namespace train_dynamics {

using DrawBarParams = LinearSpringDamper;

/// A draw-bar between two vehicles: bilateral, linear, without slack.
///
///   F = k q + c q'  [N], tension positive;  q the extension [m]
struct DrawBar {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDrawBars;
  template <class T>
  using Memory = NoMemory<T>;
  static constexpr bool kStoresByMemory = false;

  explicit DrawBar(const DrawBarParams& bar) : params(bar) {}
  template <class T>
  NoMemory<T> AtRest(T /*q*/) const {
    return {};
  }
  double Slack() const { return 0.0; }
  ConnectionTangent TangentAt(double /*force_n*/) const {
    return {params.stiffness_n_per_m, params.damping_ns_per_m, false};
  }

  DrawBarParams params;
};

template <class T>
GearForce<T> ConnectionForce(const DrawBar& bar, T q, T q_rate, NoMemory<T>& /*memory*/) {
  const T elastic = bar.params.stiffness_n_per_m * q;
  return {elastic + bar.params.damping_ns_per_m * q_rate, elastic};
}

template <class T>
T StoredEnergy(const DrawBar& bar, T q, const NoMemory<T>& /*memory*/) {
  return 0.5 * bar.params.stiffness_n_per_m * q * q;
}

}  // namespace train_dynamics
