#pragma once

#include <array>
#include <cstddef>

#include "train_dynamics/contact/polach.h"
#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

/// A wheelset's rolling motion: everything that decides its slip in one time step.
template <class T>
struct RollingInput {
  T speed;            ///< v at the end of the step if there were no creep force [m/s]
  T spin;             ///< omega at the start of the step [rad/s]
  T traction_torque;  ///< [Nm], forward positive
  T brake_torque;    ///< largest torque that brakes and resistance can exert on the turning wheels [Nm], >= 0
  T holding_torque;  ///< the same on wheels that stand [Nm], >= brake_torque
};

/// The rolling motion at the end of the step and what it took.
template <class T>
struct RollingResult {
  T speed;         ///< v [m/s]
  T spin;          ///< omega [rad/s]
  T creep_force;   ///< F [N], acts backwards on the wheelset
  T brake_torque;  ///< T [Nm], acts against positive rotation; |T| <= the largest of its state
};

/// Mass properties of equal wheelsets.
struct RollingInertia {
  double radius_m, inv_mass_per_kg, inv_inertia_per_kgm2;

  double InvInertia(std::size_t /*wheelset*/) const { return inv_inertia_per_kgm2; }
};

/// The same where drives add to the inertia of some.
template <std::size_t kCount>
struct RollingInertias {
  double radius_m, inv_mass_per_kg;
  std::array<double, kCount> inv_inertia_per_kgm2;

  double InvInertia(std::size_t wheelset) const { return inv_inertia_per_kgm2[wheelset]; }
};

/// Slip speed w with w + h F(w) = w0, and that F. Odd in w0.
template <class T>
struct SlipSolution {
  T slip, force;
};

/// Solves w + h F(w) = w0 by Newton's method.
///
/// F rises from 0 to at most N mu0 and its slope falls, so that w lies above both w0 / (1 + h F'(0)) and w0 -
/// h N mu0: from the larger bound Newton's iterates climb monotonically. (With friction that falls over the
/// slip speed the slope may turn negative, h |F'| < 0.1: the iterates are held between the bounds.) Three of
/// them leave an error in F of 1e-6 N mu0 while less than half of the friction is in use, 3e-4 N mu0 up to
/// three quarters, and at most 1.6 % of N mu0 close to full sliding below 2 m/s, always towards too much
/// force. The force returned is (w0 - w) / h: whatever error is left in w, momentum and energy are exact.
///
/// Several wheelsets are solved side by side: an iteration waits for the one before, but not for those of the
/// others.
template <class T, std::size_t kCount, class P = double>
std::array<SlipSolution<T>, kCount> SolveSlip(const std::array<CreepLaw<T, P>, kCount>& law,
                                              const std::array<T, kCount>& h,
                                              const std::array<T, kCount>& w0) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr int kIterations = 3;
  std::array<T, kCount> goal, lowest, w;
  for (std::size_t i = 0; i < kCount; ++i) {
    goal[i] = Abs(w0[i]);
    const T small_slip_slope = (kTwoOverPi * (law[i].adhesion_reduction + law[i].slip_reduction)) *
                               law[i].friction_limit * law[i].steepness;
    lowest[i] = Max(T(0.0), goal[i] - h[i] * law[i].friction_limit);
    w[i] = Max(lowest[i], goal[i] / (1.0 + h[i] * small_slip_slope));
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < kCount; ++i) {
      const CreepForce<T> creep = PolachForce(law[i], w[i]);
      const T step = (goal[i] - w[i] - h[i] * creep.force) / (1.0 + h[i] * creep.slope);
      w[i] = Clamp(w[i] + step, lowest[i], goal[i]);
    }
  }
  std::array<SlipSolution<T>, kCount> solution;
  for (std::size_t i = 0; i < kCount; ++i) {
    solution[i] = {CopySign(w[i], w0[i]), CopySign((goal[i] - w[i]) / h[i], w0[i])};
  }
  return solution;
}

template <class T>
SlipSolution<T> SolveSlip(const CreepLaw<T>& law, T h, T w0) {
  return SolveSlip<T, 1>({law}, {h}, {w0})[0];
}

/// One implicit step of the slip of wheelsets, with set-valued braking.
///
/// With the slip speed w = v - r omega and the torques of step length dt:
///
///   v1     = v* - dt F(w1) / m
///   omega1 = omega + dt (T_t + r F(w1) - T) / J
///
/// T = +-T_max while the wheels turn. Where that would turn them backwards they stop: omega1 = 0, and T is
/// what holds them, |T| <= T_hold. Shoes whose friction falls over the tread's speed hold more than they brake:
/// T_hold >= T_max, the friction being that of standstill. The creep law is stiff, dt (1/m + r^2/J) F'(0) is 40 (m/s) / v at
/// 1 ms: hence implicit. Explicit Euler diverges below 20 m/s and lets the force jump to a false branch that
/// the train's speed does not betray.
template <class T, std::size_t kCount, class P = double, class Inertia = RollingInertia>
std::array<RollingResult<T>, kCount> StepRolling(const Inertia& inertia,
                                                 const std::array<CreepLaw<T, P>, kCount>& law,
                                                 const std::array<RollingInput<T>, kCount>& in, double dt) {
  const double r = inertia.radius_m;
  const double h_locked = dt * inertia.inv_mass_per_kg;

  std::array<T, kCount>
      stopping;  // torque that would stop the wheels within this step, the creep force aside
  std::array<T, kCount> torque, h;
  std::array<MaskOf<T>, kCount> locked;
  bool any_locked = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    stopping[i] = in[i].spin * (1.0 / (dt * inertia.InvInertia(i))) + in[i].traction_torque;
    torque[i] = CopySign(in[i].brake_torque, stopping[i]);
    h[i] = T(dt * (inertia.inv_mass_per_kg + r * r * inertia.InvInertia(i)));
    locked[i] = Abs(stopping[i]) <= in[i].holding_torque + r * law[i].friction_limit;
    any_locked |= AnyOf(locked[i]);
  }
  if (any_locked) {  // may stop: find the torque that holds omega1 = 0 and see whether the brake has it
    std::array<T, kCount> speed, h_if_locked;
    for (std::size_t i = 0; i < kCount; ++i) speed[i] = in[i].speed, h_if_locked[i] = T(h_locked);
    const std::array<SlipSolution<T>, kCount> sliding = SolveSlip(law, h_if_locked, speed);
    for (std::size_t i = 0; i < kCount; ++i) {
      const T most = in[i].brake_torque, holding = stopping[i] + r * sliding[i].force;
      torque[i] = Select(locked[i], Clamp(holding, -most, most), torque[i]);
      locked[i] = locked[i] & (Abs(holding) <= in[i].holding_torque);
      h[i] = Select(locked[i], T(h_locked), h[i]);
    }
  }
  std::array<T, kCount> free_spin, free_slip;
  for (std::size_t i = 0; i < kCount; ++i) {
    const T turning_spin = in[i].spin + dt * inertia.InvInertia(i) * (in[i].traction_torque - torque[i]);
    free_spin[i] = Select(locked[i], T(0.0), turning_spin);
    free_slip[i] = in[i].speed - r * free_spin[i];
  }
  const std::array<SlipSolution<T>, kCount> solution = SolveSlip(law, h, free_slip);
  std::array<RollingResult<T>, kCount> out;
  for (std::size_t i = 0; i < kCount; ++i) {
    const T force = solution[i].force;
    const T spin = free_spin[i] + Select(locked[i], T(0.0), dt * inertia.InvInertia(i) * r * force);
    // A locked wheel's holding torque follows from the very force that acts.
    const T held = stopping[i] + r * force;
    out[i] = {in[i].speed - h_locked * force, spin, force, Select(locked[i], held, torque[i])};
  }
  return out;
}

template <class T>
RollingResult<T> StepRolling(const RollingInertia& inertia, const CreepLaw<T>& law, const RollingInput<T>& in,
                             double dt) {
  return StepRolling<T, 1>(inertia, {law}, {in}, dt)[0];
}

}  // namespace train_dynamics
