#pragma once

#include "train_dynamics/coupler/connection_law.h"
#include "train_dynamics/numeric/elementary.h"

/// Rate-independent hysteresis with a damped stick spring: the law of connections that all friction gears, measured
/// tables and buffers share.
///
/// A device (a gear, a buffer, a whole connection) has, over its travel x >= 0 [m],
///
///   Loading(x), Unloading(x)       its two branches [N], 0 <= Unloading <= Loading, not descending
///   UnloadingEnergy(x)             the integral of Unloading from 0 [J]
///   EndOfStick(x, force)           the travel x_e <= x at which the stick line from (x, force) down meets Unloading
///   Stop(x), StopEnergy(x)         the solid stop beyond the travel [N, J]
///   stick_stiffness_n_per_m        k of the stick line, above the steepest slope of both branches
///   stick_damping_ns_per_m         c while it sticks
///
/// and in a connection, with q the extension (tension positive) and x = share max(|q| - slack/2, 0),
///
///   E <- clamp(E + k dq, lower(q), upper(q))             the memory; k dq along the stick line
///   F  = clamp(E + c q', lower(q), upper(q)) + stop
///
/// the bounds being the branches with the sign of q. E depends on the path of q alone: a slow cycle takes the same
/// share of energy at any speed. While E is inside its bounds, the damper suppresses ringing.
///
/// The stored energy is what is recovered from (x, E) down the stick line and then along Unloading:
///
///   psi = U_u(x_e) + (E^2 - F_e^2) / (2 k),   F_e = Unloading(x_e)
///
/// Source: GE's FastSim [M] for tables, Chrono-like stick springs for friction; damping while it sticks is an
/// assumption [A].
namespace train_dynamics {

/// Energy that a device gives back from its travel x under a force E of its branches [J]; the stop included.
template <class T, class Device>
T RecoverableEnergy(const Device& device, T travel, T force) {
  const T end = device.EndOfStick(travel, force);
  const T end_force = device.Unloading(end);
  return device.UnloadingEnergy(end) +
         (force * force - end_force * end_force) * (0.5 / device.stick_stiffness_n_per_m) + device.StopEnergy(travel);
}

/// A connection of one kind of device, the same in tension and compression or different.
///
/// @tparam Device  see above
template <class Device>
struct HystereticConnection {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  static constexpr bool kStoresByMemory = true;
  static constexpr bool kRateIndependent = true;
  template <class T>
  using Memory = StickState<T>;

  double slack_m;
  double share;  ///< of one device in the extension: 1/2 for two equal gears in series, 1 for a whole connection
  double damping_ns_per_m = 0.0;  ///< b, of the connection, beyond its slack
  Device tension, compression;
  bool symmetric;  ///< compression is not used

  double Slack() const { return slack_m; }
  template <class T>
  StickState<T> AtRest(T q) const {
    return {q, T(0.0)};
  }
  [[gnu::always_inline]] double Stiffness() const { return share * tension.stick_stiffness_n_per_m; }
  [[gnu::always_inline]] double Damping() const { return share * tension.stick_damping_ns_per_m; }
  /// While it sticks.
  ConnectionTangent TangentAt(double /*force_n*/) const { return {Stiffness(), Damping() + damping_ns_per_m, false}; }
};

/// Forces between which a connection sticks.
template <class T>
struct StickBounds {
  T lower, upper;  ///< tension positive
  T stop;          ///< beside them, >= 0
  T travel;        ///< x
};

template <class T, class Device>
StickBounds<T> BoundsAt(const HystereticConnection<Device>& c, T q) {
  const T travel = c.share * Max(T(0.0), Abs(q) - 0.5 * c.slack_m);
  const MaskOf<T> pushed = q < T(0.0);
  T loading = c.tension.Loading(travel), unloading = c.tension.Unloading(travel), stop = c.tension.Stop(travel);
  if (!c.symmetric) {
    loading = Select(pushed, c.compression.Loading(travel), loading);
    unloading = Select(pushed, c.compression.Unloading(travel), unloading);
    stop = Select(pushed, c.compression.Stop(travel), stop);
  }
  return {Select(pushed, -loading, unloading), Select(pushed, -unloading, loading), stop, travel};
}

template <class T, class Device>
GearForce<T> ConnectionForce(const HystereticConnection<Device>& c, T q, T q_rate, StickState<T>& memory) {
  const StickBounds<T> at = BoundsAt(c, q);
  memory.force = Clamp(memory.force + c.Stiffness() * (q - memory.q), at.lower, at.upper);
  memory.q = q;
  T force = Clamp(memory.force + c.Damping() * q_rate, at.lower, at.upper) + CopySign(at.stop, q);
  if (c.damping_ns_per_m > 0.0) {
    // Never turns a push into a pull.
    const T along = CopySign(T(1.0), q);
    const T size = Max(T(0.0), force * along + c.damping_ns_per_m * q_rate * along);
    force = Select(at.travel > T(0.0), size * along, force);
  }
  return {force, force};
}

template <class T, class Device>
T StoredEnergy(const HystereticConnection<Device>& c, T q, const StickState<T>& memory) {
  const StickBounds<T> at = BoundsAt(c, q);
  const T force = Abs(Clamp(memory.force + c.Stiffness() * (q - memory.q), at.lower, at.upper));
  T stored = RecoverableEnergy(c.tension, at.travel, force);
  if (!c.symmetric) stored = Select(q < T(0.0), RecoverableEnergy(c.compression, at.travel, force), stored);
  return (1.0 / c.share) * stored;
}

}  // namespace train_dynamics
