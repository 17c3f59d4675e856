#pragma once

#include "train_dynamics/coupler/damped_stick_gear.h"
#include "train_dynamics/coupler/table_gear.h"

namespace train_dynamics {

/// One draft gear of a connection that has two different ones.
struct OneGearParams {
  enum class Kind { kFriction, kTable };
  Kind kind = Kind::kFriction;
  DraftGearParams draft_gear;
  TableGearParams table;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("kind", kind, {{"draft_gear", Kind::kFriction}, {"table", Kind::kTable}},
             "draft_gear: a friction gear; table: a measured gear");
    const char* const no_slack = "must be 0: the slack is that of the connection";
    if (kind == Kind::kFriction) {
      if (draft_gear.slack_m != draft_gear.slack_m) {  // nothing was read yet
        draft_gear.slack_m = 0.0;
        draft_gear.friction = DraftGearFriction::kDampedStick;
      }
      v.Group("draft_gear", draft_gear, "the friction gear, with friction damped_stick and without slack");
      v.Check(draft_gear.slack_m == 0.0, "draft_gear.slack_m", no_slack);
      v.Check(draft_gear.friction == DraftGearFriction::kDampedStick, "draft_gear.friction",
              "must be damped_stick for one gear of two");
    } else {
      v.Group("table", table, "the measured gear, without slack");
      v.Check(table.slack_m == 0.0, "table.slack_m", no_slack);
      v.Check(table.damping_ns_per_m == 0.0, "table.damping_ns_per_m", "must be 0 for one gear of two");
      v.Check(!table.compression, "table.compression", "must not be given for one gear, which is only pushed in");
    }
  }
};

/// Two different draft gears in series.
struct UnequalGearsParams {
  double slack_m = kRequired;
  OneGearParams front_gear, rear_gear;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("slack_m", slack_m, kNonNegative, "total free play of the connection");
    v.Group("front_gear", front_gear, "gear of the vehicle in front");
    v.Group("rear_gear", rear_gear, "gear of the vehicle behind");
  }
};

/// Memory of two different gears in series; forces without stops, >= 0.
template <class T>
struct UnequalState {
  T q;                           ///< extension at the last evaluation [m]
  T travel_a, force_a, force_b;  ///< of the first gear [m], of both [N]

  template <class Function>
  void ForEachField(Function&& field) {
    field(q);
    field(travel_a);
    field(force_a);
    field(force_b);
  }
};

/// Two different devices in series (coupler/hysteresis.h), each with its own memory E:
///
///   x_a + x_b = x = max(|q| - slack/2, 0),   E_a + stop_a = E_b + stop_b = F
///
/// solved for x_a by bisection, because both sides ascend with their travel. While both stick a damper in series,
/// c_a c_b / (c_a + c_b), acts on top, within the bounds of both.
template <class DeviceA, class DeviceB>
struct UnequalGears {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  static constexpr bool kStoresByMemory = true;
  static constexpr bool kRateIndependent = true;
  template <class T>
  using Memory = UnequalState<T>;

  double slack_m;
  DeviceA a;
  DeviceB b;

  double Slack() const { return slack_m; }
  template <class T>
  UnequalState<T> AtRest(T q) const {
    return {q, T(0.0), T(0.0), T(0.0)};
  }
  [[gnu::always_inline]] double Stiffness() const {
    return a.stick_stiffness_n_per_m * b.stick_stiffness_n_per_m /
           (a.stick_stiffness_n_per_m + b.stick_stiffness_n_per_m);
  }
  [[gnu::always_inline]] double Damping() const {
    const double sum = a.stick_damping_ns_per_m + b.stick_damping_ns_per_m;
    return sum > 0.0 ? a.stick_damping_ns_per_m * b.stick_damping_ns_per_m / sum : 0.0;
  }
  ConnectionTangent TangentAt(double /*force_n*/) const { return {Stiffness(), Damping(), false}; }
};

/// The force E of a device after its travel has changed [N].
template <class T, class Device>
T Stick(const Device& device, T travel, T last_travel, T last_force) {
  return Clamp(last_force + device.stick_stiffness_n_per_m * (travel - last_travel), device.Unloading(travel),
               device.Loading(travel));
}

/// The memory after the extension has come to q.
template <class T, class DeviceA, class DeviceB>
UnequalState<T> Moved(const UnequalGears<DeviceA, DeviceB>& gears, T q, const UnequalState<T>& last) {
  constexpr int kHalvings = 50;  // to 1e-15 of the travel
  const T total = Max(T(0.0), Abs(q) - 0.5 * gears.slack_m);
  const T last_total = Max(T(0.0), Abs(last.q) - 0.5 * gears.slack_m);
  const MaskOf<T> turned = q * last.q < T(0.0);  // from tension to compression: both gears have been free
  const T last_a = Select(turned, T(0.0), last.travel_a);
  const T last_b = Select(turned, T(0.0), last_total - last.travel_a);
  const T force_a = Select(turned, T(0.0), last.force_a), force_b = Select(turned, T(0.0), last.force_b);
  T low(0.0), high = total;
  for (int i = 0; i < kHalvings; ++i) {
    const T middle = 0.5 * (low + high);
    const T rest = total - middle;
    const MaskOf<T> too_far = Stick(gears.a, middle, last_a, force_a) + gears.a.Stop(middle) >
                              Stick(gears.b, rest, last_b, force_b) + gears.b.Stop(rest);
    high = Select(too_far, middle, high);
    low = Select(too_far, low, middle);
  }
  const T travel_a = 0.5 * (low + high);
  return {q, travel_a, Stick(gears.a, travel_a, last_a, force_a), Stick(gears.b, total - travel_a, last_b, force_b)};
}

template <class T, class DeviceA, class DeviceB>
GearForce<T> ConnectionForce(const UnequalGears<DeviceA, DeviceB>& gears, T q, T q_rate, UnequalState<T>& memory) {
  memory = Moved(gears, q, memory);
  const T travel_b = Max(T(0.0), Abs(q) - 0.5 * gears.slack_m) - memory.travel_a;
  const T stop_a = gears.a.Stop(memory.travel_a), stop_b = gears.b.Stop(travel_b);
  const T lower = Max(gears.a.Unloading(memory.travel_a) + stop_a, gears.b.Unloading(travel_b) + stop_b);
  const T upper = Min(gears.a.Loading(memory.travel_a) + stop_a, gears.b.Loading(travel_b) + stop_b);
  const T size = memory.force_a + stop_a + gears.Damping() * q_rate * CopySign(T(1.0), q);
  const T force = CopySign(Max(Min(size, upper), Min(lower, upper)), q);
  return {force, force};
}

template <class T, class DeviceA, class DeviceB>
T StoredEnergy(const UnequalGears<DeviceA, DeviceB>& gears, T q, const UnequalState<T>& memory) {
  const UnequalState<T> now = Moved(gears, q, memory);
  const T travel_b = Max(T(0.0), Abs(q) - 0.5 * gears.slack_m) - now.travel_a;
  return RecoverableEnergy(gears.a, now.travel_a, now.force_a) + RecoverableEnergy(gears.b, travel_b, now.force_b);
}

/// The law of two gears; which of them is in front does not matter to the force.
/// @tparam Law  a variant of the three
template <class Law>
Law UnequalGearsOf(const UnequalGearsParams& p) {
  const auto friction = [](const OneGearParams& gear) { return FrictionDevice(gear.draft_gear); };
  const auto table = [](const OneGearParams& gear) {
    return TableDevice(gear.table.tables, gear.table.locked_stiffness_n_per_m, gear.table.locked_damping_ns_per_m,
                       gear.table.solid_stiffness_n_per_m);
  };
  const bool front_rubs = p.front_gear.kind == OneGearParams::Kind::kFriction;
  const bool rear_rubs = p.rear_gear.kind == OneGearParams::Kind::kFriction;
  if (front_rubs && rear_rubs) {
    return UnequalGears<FrictionDevice, FrictionDevice>{p.slack_m, friction(p.front_gear), friction(p.rear_gear)};
  }
  if (front_rubs || rear_rubs) {
    return UnequalGears<FrictionDevice, TableDevice>{p.slack_m, friction(front_rubs ? p.front_gear : p.rear_gear),
                                                     table(front_rubs ? p.rear_gear : p.front_gear)};
  }
  return UnequalGears<TableDevice, TableDevice>{p.slack_m, table(p.front_gear), table(p.rear_gear)};
}

}  // namespace train_dynamics
