#pragma once

#include "train_dynamics/coupler/force_curve.h"

namespace train_dynamics {

/// A spring of side buffers or of a draw hook, by tables of one of them.
struct BufferSpringParams {
  double locked_stiffness_n_per_m = kRequired;
  double locked_damping_ns_per_m = 1.0e5;
  double solid_stiffness_n_per_m = 1.0e8;
  HysteresisParams tables;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("locked_stiffness_n_per_m", locked_stiffness_n_per_m, kPositive,
             "k of the line between the curves, while it sticks");
    v.Number("locked_damping_ns_per_m", locked_damping_ns_per_m, kNonNegative, "c while it sticks");
    v.Number("solid_stiffness_n_per_m", solid_stiffness_n_per_m, kPositive, "stiffness beyond the last point");
    tables.Visit(v);
    v.Check(locked_stiffness_n_per_m > tables.SteepestSlope(), "locked_stiffness_n_per_m",
            "must exceed the steepest slope of the tables, " + ShortestDecimal(tables.SteepestSlope()) + " N/m",
            {"loading", "unloading"});
  }
  TableDevice Device() const {
    return {tables, locked_stiffness_n_per_m, locked_damping_ns_per_m, solid_stiffness_n_per_m};
  }
};

/// Screw coupling with two side buffers at each end.
struct SideBuffersParams {
  double pretension_travel_m = 0.010;
  BufferSpringParams buffer;
  BufferSpringParams draw_gear;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("pretension_travel_m", pretension_travel_m, kNonNegative,
             "d_0, travel of each buffer when nothing pulls, by the tightened screw");
    v.Group("buffer", buffer, "one of the four buffers");
    v.Group("draw_gear", draw_gear, "both draw gears and the screw together");
    v.Check(buffer.tables.loading.travel_m.empty() || pretension_travel_m <= buffer.tables.loading.travel_m.back(),
            "pretension_travel_m", "must lie within the travel of the buffers", {"buffer"});
    v.Check(PretensionIsReached(), "draw_gear", "must reach the force of two buffers at pretension_travel_m",
            {"buffer", "draw_gear", "pretension_travel_m"});
  }

 private:
  bool PretensionIsReached() const;
};

/// Memory of side buffers and draw gear; forces without stops, >= 0.
template <class T>
struct SideBuffersState {
  T q;                         ///< extension at the last evaluation [m]
  T buffer_force, draw_force;  ///< of one buffer, of the draw gear [N]

  template <class Function>
  void ForEachField(Function&& field) {
    field(q);
    field(buffer_force);
    field(draw_force);
  }
};

/// Side buffers with a screw coupling: buffers face to face push, the draw gear pulls, both with hysteresis
/// (coupler/hysteresis.h), side by side.
///
///   x_b = max(d_0 - q/2, 0) of each buffer,   x_d = max(s_0 + q, 0) of the draw gear
///   F = F_d(x_d) - 2 F_b(x_b),  tension positive
///
/// s_0 such that the means of loading and unloading balance at q = 0, where a train starts. Vehicles that push each
/// other harder slacken the screw; pulled by more than 2 d_0 the buffers part.
struct SideBuffers {
  static constexpr ConnectionAccount kAccount = ConnectionAccount::kDraftGears;
  static constexpr bool kStoresByMemory = true;
  static constexpr bool kRateIndependent = true;
  template <class T>
  using Memory = SideBuffersState<T>;

  explicit SideBuffers(const SideBuffersParams& params);

  double Slack() const { return 0.0; }
  template <class T>
  SideBuffersState<T> AtRest(T q) const {
    return {q, T(0.5 * pretension_n), T(pretension_n)};
  }
  ConnectionTangent TangentAt(double /*force_n*/) const {
    return {draw_gear.stick_stiffness_n_per_m + buffer.stick_stiffness_n_per_m,
            draw_gear.stick_damping_ns_per_m + buffer.stick_damping_ns_per_m, false};
  }
  template <class T>
  T BufferTravel(T q) const {
    return Max(T(0.0), pretension_travel_m - 0.5 * q);
  }
  template <class T>
  T DrawTravel(T q) const {
    return Max(T(0.0), draw_travel_m + q);
  }

  TableDevice buffer, draw_gear;
  double pretension_travel_m;  ///< d_0
  double draw_travel_m;        ///< s_0
  double pretension_n;         ///< of the draw gear at q = 0
};

/// The memory after the extension has come to q.
template <class T>
SideBuffersState<T> Moved(const SideBuffers& c, T q, const SideBuffersState<T>& last) {
  const auto stick = [](const TableDevice& device, T travel, T last_travel, T force) {
    return Clamp(force + device.stick_stiffness_n_per_m * (travel - last_travel), device.Unloading(travel),
                 device.Loading(travel));
  };
  return {q, stick(c.buffer, c.BufferTravel(q), c.BufferTravel(last.q), last.buffer_force),
          stick(c.draw_gear, c.DrawTravel(q), c.DrawTravel(last.q), last.draw_force)};
}

template <class T>
GearForce<T> ConnectionForce(const SideBuffers& c, T q, T q_rate, SideBuffersState<T>& memory) {
  memory = Moved(c, q, memory);
  const auto damped = [](const TableDevice& device, T travel, T force, T rate) {
    return Clamp(force + device.stick_damping_ns_per_m * rate, device.Unloading(travel), device.Loading(travel)) +
           device.Stop(travel);
  };
  const T push = damped(c.buffer, c.BufferTravel(q), memory.buffer_force, T(-0.5) * q_rate);
  const T force = damped(c.draw_gear, c.DrawTravel(q), memory.draw_force, q_rate) - 2.0 * push;
  return {force, force};
}

template <class T>
T StoredEnergy(const SideBuffers& c, T q, const SideBuffersState<T>& memory) {
  const SideBuffersState<T> now = Moved(c, q, memory);
  return 4.0 * RecoverableEnergy(c.buffer, c.BufferTravel(q), now.buffer_force) +
         RecoverableEnergy(c.draw_gear, c.DrawTravel(q), now.draw_force);
}

}  // namespace train_dynamics
