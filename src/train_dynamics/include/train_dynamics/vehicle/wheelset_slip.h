#pragma once

#include "train_dynamics/contact/polach.h"
#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

/// A wheelset's rolling motion: everything that decides its slip in one time step.
template <class T>
struct RollingInput {
  T speed;            ///< v at the end of the step if there were no creep force [m/s]
  T spin;             ///< omega at the start of the step [rad/s]
  T traction_torque;  ///< [Nm], forward positive
  T brake_torque;     ///< largest torque that brakes and resistance can exert [Nm], >= 0
};

/// The rolling motion at the end of the step and what it took.
template <class T>
struct RollingResult {
  T speed;         ///< v [m/s]
  T spin;          ///< omega [rad/s]
  T creep_force;   ///< F [N], acts backwards on the wheelset
  T brake_torque;  ///< T [Nm], acts against positive rotation; |T| <= the largest
};

/// Mass properties of a wheelset.
struct RollingInertia {
  double radius_m, inv_mass_per_kg, inv_inertia_per_kgm2;
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
template <class T>
SlipSolution<T> SolveSlip(const CreepLaw<T>& law, T h, T w0) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr int kIterations = 3;
  const T goal = Abs(w0);
  const T small_slip_slope =
      (kTwoOverPi * (law.adhesion_reduction + law.slip_reduction)) * law.friction_limit * law.steepness;
  const T lowest = Max(T(0.0), goal - h * law.friction_limit);
  T w = Max(lowest, goal / (1.0 + h * small_slip_slope));
  for (int i = 0; i < kIterations; ++i) {
    const CreepForce<T> creep = PolachForce(law, w);
    w = Clamp(w + (goal - w - h * creep.force) / (1.0 + h * creep.slope), lowest, goal);
  }
  return {CopySign(w, w0), CopySign((goal - w) / h, w0)};
}

/// One implicit step of a wheelset's slip, with set-valued braking.
///
/// With the slip speed w = v - r omega and the torques of step length dt:
///
///   v1     = v* - dt F(w1) / m
///   omega1 = omega + dt (T_t + r F(w1) - T) / J
///
/// T = +-T_max while the wheels turn. Where that would turn them backwards they stop: omega1 = 0, and T is
/// what holds them, |T| <= T_max. The creep law is stiff, dt (1/m + r^2/J) F'(0) is 40 (m/s) / v at
/// 1 ms: hence implicit. Explicit Euler diverges below 20 m/s and lets the force jump to a false branch that
/// the train's speed does not betray.
template <class T>
RollingResult<T> StepRolling(const RollingInertia& inertia, const CreepLaw<T>& law, const RollingInput<T>& in,
                             double dt) {
  const double r = inertia.radius_m;
  const double h_locked = dt * inertia.inv_mass_per_kg;
  const double h_turning = dt * (inertia.inv_mass_per_kg + r * r * inertia.inv_inertia_per_kgm2);

  // Torque that would stop the wheels within this step, the creep force aside.
  const T stopping = in.spin * (1.0 / (dt * inertia.inv_inertia_per_kgm2)) + in.traction_torque;
  T torque = CopySign(in.brake_torque, stopping);
  MaskOf<T> locked = Abs(stopping) <= in.brake_torque + r * law.friction_limit;
  T h(h_turning);
  if (AnyOf(locked)) {  // may stop: find the torque that holds omega1 = 0 and see whether the brake has it
    const T holding = stopping + r * SolveSlip(law, T(h_locked), in.speed).force;
    torque = Select(locked, Clamp(holding, -in.brake_torque, in.brake_torque), torque);
    locked = locked & (Abs(holding) <= in.brake_torque);
    h = Select(locked, T(h_locked), h);
  }
  const T turning_spin = in.spin + dt * inertia.inv_inertia_per_kgm2 * (in.traction_torque - torque);
  const T free_spin = Select(locked, T(0.0), turning_spin);
  const SlipSolution<T> solution = SolveSlip(law, h, in.speed - r * free_spin);
  const T spin = free_spin + Select(locked, T(0.0), dt * inertia.inv_inertia_per_kgm2 * r * solution.force);
  // A locked wheel's holding torque follows from the very force that acts.
  const T held = stopping + r * solution.force;
  return {in.speed - h_locked * solution.force, spin, solution.force, Select(locked, held, torque)};
}

}  // namespace train_dynamics
