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
  T brake_torque;     ///< largest torque that brakes and resistance can exert on the turning wheels [Nm], >= 0
  T holding_torque;   ///< the same on wheels at rest [Nm], >= brake_torque
  T slip;             ///< w at the start of the step [m/s]: where the search for that at the end begins
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

/// Newton's iterate after w of w + h F(w) = goal, by sizes, held between bounds.
template <class T, class P>
T NextSlip(const CreepLaw<T, P>& law, const T& h, const T& goal, const T& lowest, const T& w) {
  const CreepForce<T> creep = PolachForce(law, w);
  const T step = (goal - w - h * creep.force) / (1.0 + h * creep.slope);
  return Clamp(w + step, lowest, goal);
}

/// Whether a wheelset needs another iteration: its iterate has moved by more than a thousandth of itself.
template <class T>
MaskOf<T> IsOnTheWay(const T& w, const T& next) {
  return Abs(next - w) > 1e-3 * next;
}

/// Solves w + h F(w) = w0 by Newton's method, from a guess of w.
///
/// F rises from 0 to at most N mu0 and its slope falls: w lies above w0 - h N mu0, and Newton's iterates, whatever the
/// guess, do not pass it. They climb, held at or above that bound and 0. (With friction that falls over the slip speed
/// the slope may turn negative, h |F'| < 0.1: they are held at or below w0 too.) A wheelset has converged when its
/// iterate moved by less than a thousandth of itself: by Taylor's theorem F is then wrong by w^2 F'' 1e-6 / 2, less
/// than 1e-6 N mu0, towards too much force (or, where friction falls, by up to 2.7e-7 (1 - A) N mu0 towards too
/// little). From the slip of the step before, that takes a rolling wheelset one iteration, seldom two. The force
/// returned is (w0 - w) / h: whatever error is left in w, momentum and energy are exact.
///
/// Several wheelsets are solved side by side, in each lane of T too: an iteration waits for the one before, but not for
/// those of the others. One that has converged stays fixed while others continue, so that its result does not depend on
/// them.
/// @param guess  of w, with its sign; it decides how soon w is found
template <class T, std::size_t kCount, class P = double>
std::array<SlipSolution<T>, kCount> SolveSlip(const std::array<CreepLaw<T, P>, kCount>& law,
                                              const std::array<T, kCount>& h, const std::array<T, kCount>& w0,
                                              const std::array<T, kCount>& guess) {
  constexpr int kMostIterations = 12;  // a bound on the time; from w = 0, seven were the most seen
  std::array<T, kCount> goal, lowest, w;
  for (std::size_t i = 0; i < kCount; ++i) {
    goal[i] = Abs(w0[i]);
    lowest[i] = Max(T(0.0), goal[i] - h[i] * law[i].friction_limit);
    w[i] = Clamp(Abs(guess[i]), lowest[i], goal[i]);
  }
  const auto iterate = [&] {  // a loop by itself: the compiler writes only short ones out
    std::array<T, kCount> next;
    for (std::size_t i = 0; i < kCount; ++i) next[i] = NextSlip(law[i], h[i], goal[i], lowest[i], w[i]);
    return next;
  };
  std::array<T, kCount> next = iterate();
  std::array<MaskOf<T>, kCount> on_the_way;
  MaskOf<T> any = T(0.0) != T(0.0);
  for (std::size_t i = 0; i < kCount; ++i) {
    on_the_way[i] = IsOnTheWay(w[i], next[i]);
    any = any | on_the_way[i];
    w[i] = next[i];
  }
  for (int iteration = 1; AnyOf(any) && iteration < kMostIterations; ++iteration) {
    next = iterate();
    any = T(0.0) != T(0.0);
    for (std::size_t i = 0; i < kCount; ++i) {
      const MaskOf<T> goes_on = on_the_way[i] & IsOnTheWay(w[i], next[i]);
      w[i] = Select(on_the_way[i], next[i], w[i]);
      on_the_way[i] = goes_on;
      any = any | goes_on;
    }
  }
  std::array<SlipSolution<T>, kCount> solution;
  for (std::size_t i = 0; i < kCount; ++i) {
    solution[i] = {CopySign(w[i], w0[i]), CopySign((goal[i] - w[i]) / h[i], w0[i])};
  }
  return solution;
}

template <class T>
SlipSolution<T> SolveSlip(const CreepLaw<T>& law, T h, T w0, T guess) {
  return SolveSlip<T, 1>({law}, {h}, {w0}, {guess})[0];
}

/// One implicit step of the slip of wheelsets, with set-valued braking.
///
/// With the slip speed w = v - r omega and the torques of step length dt:
///
///   v1     = v* - dt F(w1) / m
///   omega1 = omega + dt (T_t + r F(w1) - T) / J
///
/// T = +-T_max while the wheels turn. Where that would turn them backwards they stop: omega1 = 0, and T is what holds
/// them, |T| <= T_hold. Shoes whose friction falls over the tread's speed hold more than they brake: T_hold >= T_max,
/// the friction being that of standstill. The creep law is stiff, dt (1/m + r^2/J) F'(0) is 40 (m/s) / v at 1 ms: hence
/// implicit. Explicit Euler diverges below 20 m/s and lets the force jump to a false branch that the train's speed does
/// not betray.
template <class T, std::size_t kCount, class P = double, class Inertia = RollingInertia>
std::array<RollingResult<T>, kCount> StepRolling(const Inertia& inertia, const std::array<CreepLaw<T, P>, kCount>& law,
                                                 const std::array<RollingInput<T>, kCount>& in, double dt) {
  const double r = inertia.radius_m;
  const double h_locked = dt * inertia.inv_mass_per_kg;

  // stopping: the torque that would stop the wheels within this step, the creep force aside.
  std::array<T, kCount> stopping, torque, h, slip;
  std::array<MaskOf<T>, kCount> locked;
  bool any_locked = false;
  for (std::size_t i = 0; i < kCount; ++i) {
    stopping[i] = in[i].spin * (1.0 / (dt * inertia.InvInertia(i))) + in[i].traction_torque;
    torque[i] = CopySign(in[i].brake_torque, stopping[i]);
    h[i] = T(dt * (inertia.inv_mass_per_kg + r * r * inertia.InvInertia(i)));
    slip[i] = in[i].slip;
    locked[i] = Abs(stopping[i]) <= in[i].holding_torque + r * law[i].friction_limit;
    any_locked |= AnyOf(locked[i]);
  }
  if (any_locked) {  // may stop: find the torque that holds omega1 = 0 and see whether the brake has it
    std::array<T, kCount> speed, h_if_locked;
    for (std::size_t i = 0; i < kCount; ++i) speed[i] = in[i].speed, h_if_locked[i] = T(h_locked);
    const std::array<SlipSolution<T>, kCount> sliding = SolveSlip(law, h_if_locked, speed, slip);
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
  const std::array<SlipSolution<T>, kCount> solution = SolveSlip(law, h, free_slip, slip);
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
