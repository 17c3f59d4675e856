#pragma once

#include "train_dynamics/coupler/connection_law.h"
#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// How the direction of the friction in a draft gear is decided.
enum class DraftGearFriction {
  kSmooth,       ///< mu ~ tanh(w / v_e): a function of the present rate only
  kStickSpring,  ///< the force moves along a stiff spring between the unloading and the loading branch
  kDampedStick,  ///< likewise, mu the same at any speed, and damped: the default for real trains
  kLuGre,        ///< mu follows the sliding over a length: a study
};

/// A friction draft gear; two equal ones are in series with the slack of one coupler connection.
struct DraftGearParams {
  double slack_m = kRequired;
  double preload_n = kRequired;
  double preload_travel_m = 0.001;
  double spring_stiffness_n_per_m = kRequired;
  double spring_hardening_n_per_m3 = 0.0;
  double travel_m = kRequired;
  double solid_stiffness_n_per_m = kRequired;
  double wedge_angle_deg = kRequired;
  double static_friction_coefficient = kRequired;
  double kinetic_friction_coefficient = kRequired;
  double stribeck_speed_mps = kRequired;
  DraftGearFriction friction = DraftGearFriction::kSmooth;
  double smoothing_speed_mps = kRequired;
  double stick_stiffness_n_per_m = 1.0e9;
  double gear_stick_stiffness_n_per_m = 1.0e9;
  double gear_stick_damping_ns_per_m = 2.6e6;
  double friction_length_m = 0.105e-3;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("friction", friction,
             {{"smooth", DraftGearFriction::kSmooth},
              {"stick_spring", DraftGearFriction::kStickSpring},
              {"damped_stick", DraftGearFriction::kDampedStick},
              {"lugre", DraftGearFriction::kLuGre}},
             "smooth: a function of the present rate only; stick_spring: moves along a stiff spring between "
             "the branches; damped_stick: likewise, damped, for real trains; lugre: a study");
    const bool damped_stick = friction == DraftGearFriction::kDampedStick;
    if (friction != DraftGearFriction::kSmooth) NotRequired(smoothing_speed_mps);
    if (damped_stick) NotRequired(stribeck_speed_mps);
    v.Number("slack_m", slack_m, kNonNegative, "total free play of the connection");
    v.Number("preload_n", preload_n, kNonNegative, "F_0, preload of one gear");
    v.Number("preload_travel_m", preload_travel_m, kPositive, "travel over which the preload builds up");
    v.Number("spring_stiffness_n_per_m", spring_stiffness_n_per_m, kPositive, "k_s of one gear");
    v.Number("spring_hardening_n_per_m3", spring_hardening_n_per_m3, kNonNegative, "k_3 of one gear");
    v.Number("travel_m", travel_m, kPositive, "d_max of one gear");
    v.Number("solid_stiffness_n_per_m", solid_stiffness_n_per_m, kPositive,
             "stiffness of the stop of one gear beyond d_max");
    v.Number("wedge_angle_deg", wedge_angle_deg, Range{0.0, 90.0}, "phi, angle of the wedge");
    v.Number("static_friction_coefficient", static_friction_coefficient, kNonNegative, "mu_s, on the wedge");
    v.Number("kinetic_friction_coefficient", kinetic_friction_coefficient, kNonNegative, "mu_k, on the wedge");
    v.Number("stribeck_speed_mps", stribeck_speed_mps, kPositive,
             "v_s, rate of one gear's travel over which friction falls from mu_s to mu_k; not of friction "
             "damped_stick");
    v.Number("smoothing_speed_mps", smoothing_speed_mps, kPositive,
             "v_e, rate of one gear's travel over which friction changes its sign; friction smooth");
    v.Number("stick_stiffness_n_per_m", stick_stiffness_n_per_m, kPositive,
             "stiffness of the connection while it sticks; friction stick_spring");
    v.Number("gear_stick_stiffness_n_per_m", gear_stick_stiffness_n_per_m, kPositive,
             "k_st, stiffness of one gear while it sticks; friction damped_stick");
    v.Number("gear_stick_damping_ns_per_m", gear_stick_damping_ns_per_m, kNonNegative,
             "c_st, damping of one gear while it sticks; friction damped_stick");
    v.Number("friction_length_m", friction_length_m, kPositive,
             "ell, travel of one gear over which friction builds up; friction lugre");
    v.Check(kinetic_friction_coefficient <= static_friction_coefficient, "kinetic_friction_coefficient",
            "must be at most static_friction_coefficient");
    v.Check(static_friction_coefficient < TanWedge(), "static_friction_coefficient",
            "must be below the tangent of wedge_angle_deg: the gear would lock itself");
    v.Check(!damped_stick || kinetic_friction_coefficient == static_friction_coefficient,
            "kinetic_friction_coefficient", "must equal static_friction_coefficient for friction damped_stick");
    v.Check(!damped_stick || gear_stick_stiffness_n_per_m > SteepestLoading(), "gear_stick_stiffness_n_per_m",
            "must exceed the steepest slope of the loading branch, " + ShortestDecimal(SteepestLoading()) + " N/m",
            {"friction", "preload_n", "preload_travel_m", "spring_stiffness_n_per_m", "spring_hardening_n_per_m3",
             "travel_m", "wedge_angle_deg", "static_friction_coefficient"});
  }

  /// tan(phi) [-].
  double TanWedge() const;
  /// The steepest slope of F_s t / (t - mu_s) over the travel [N/m].
  double SteepestLoading() const;

 private:
  /// A number that the chosen friction does not use need not be given.
  static void NotRequired(double& value) {
    if (value != value) value = 1.0;
  }
};

/// What is constant in a connection of two draft gears.
struct DraftGear {
  explicit DraftGear(const DraftGearParams& gear) : params(gear), tan_wedge(gear.TanWedge()) {}
  DraftGearParams params;
  double tan_wedge;
};

/// Coefficient of friction on a gear's wedges at the speed |w| of its travel, without its direction [-].
///
///   mu = mu_k + (mu_s - mu_k) exp(-|w| / v_s)
template <class T>
T GearFrictionCoefficient(const DraftGearParams& p, T speed) {
  return p.kinetic_friction_coefficient + (p.static_friction_coefficient - p.kinetic_friction_coefficient) *
                                              Exp(Abs(speed) * (-1.0 / p.stribeck_speed_mps));
}

/// Spring force of one gear [N] at its travel d >= 0, without the solid stop:
///
///   F_s = F_0 min(d / d_0, 1) + k_s d + k_3 d^3
template <class T>
T GearSpringForce(const DraftGearParams& p, T travel) {
  const T linear = p.preload_n * Min(T(1.0), travel * (1.0 / p.preload_travel_m)) + p.spring_stiffness_n_per_m * travel;
  if (p.spring_hardening_n_per_m3 == 0.0) return linear;
  return linear + p.spring_hardening_n_per_m3 * travel * travel * travel;
}

/// Its slope [N/m].
template <class T>
T GearSpringSlope(const DraftGearParams& p, T travel) {
  const T preload = Select(travel < p.preload_travel_m, T(p.preload_n / p.preload_travel_m), T(0.0));
  return preload + p.spring_stiffness_n_per_m + 3.0 * p.spring_hardening_n_per_m3 * travel * travel;
}

/// Its integral from 0 [J].
template <class T>
T GearSpringEnergy(const DraftGearParams& p, T travel) {
  const T ramp = Min(T(p.preload_travel_m), travel);
  const T square = travel * travel;
  return p.preload_n * (0.5 * ramp * ramp * (1.0 / p.preload_travel_m) + (travel - ramp)) +
         0.5 * p.spring_stiffness_n_per_m * square + 0.25 * p.spring_hardening_n_per_m3 * square * square;
}

/// Force of the solid stop of one gear [N].
template <class T>
T GearStopForce(const DraftGearParams& p, T travel) {
  return p.solid_stiffness_n_per_m * Max(T(0.0), travel - p.travel_m);
}

/// Travel of each of the two gears [m], >= 0, when the connection is extended by q (tension positive).
template <class T>
T GearTravel(const DraftGearParams& p, T q) {
  return 0.5 * Max(T(0.0), Abs(q) - 0.5 * p.slack_m);
}

/// Elastic energy of a connection's two gears [J]: 2 times the integral of F_s + F_stop over d.
template <class T>
T GearEnergy(const DraftGearParams& p, T q) {
  const T d = GearTravel(p, q);
  const T stop = Max(T(0.0), d - p.travel_m);
  return 2.0 * (GearSpringEnergy(p, d) + 0.5 * p.solid_stiffness_n_per_m * stop * stop);
}

}  // namespace train_dynamics
