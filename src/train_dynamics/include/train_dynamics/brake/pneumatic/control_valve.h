#pragma once

#include <string>

#include "train_dynamics/brake/pneumatic/air.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

enum class ControlValveKind {
  kDirectRelease,     ///< AAR AB type: a rise of the pipe releases fully
  kGraduatedRelease,  ///< UIC distributor: the cylinder follows the pipe up and down
  kEcp,  ///< electronically controlled: the cylinder follows a goal sent to all at once; the pipe only feeds
};

/// Direct release, AB type. Thresholds after the generic car valve of the TPS manual [S]: 0.75, 0.25, 1.75 psi. Its
/// passages to the cylinder are 1/8 in; here 2.4 mm [A], with which a rack of 150 cars vented at both ends fills all
/// cylinders to 99 % in the published 16 s (3.2 mm: 11 s). The passages that take air from the pipe in an application
/// are so small [A] that even many in a row do not lower the pipe fast enough for an emergency (with 3.2 and 1.0 mm the
/// tail of 150 wagons does).
struct DirectReleaseParams {
  double apply_kpa = 5.2;
  double lap_kpa = 1.7;
  double release_kpa = 12.0;
  double emergency_reservoir_l = 57.4;
  double quick_service_volume_l = 0.6;
  double quick_service_kpa = 35.0;
  double quick_service_opening_mm = 0.5;
  double minimum_cylinder_kpa = 70.0;
  double limiting_opening_mm = 0.4;
  double emergency_opening_mm = 2.4;
  double vent_opening_mm = 6.35;
  double quick_action_time_s = 0.6;
  double quick_action_threshold_kpa = 20.0;
  double vent_closes_below_kpa = 50.0;
  double vent_time_s = 60.0;
  bool accelerated_release = false;
  double accelerated_release_kpa = 140.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("apply_kpa", apply_kpa, Range{0.5, 50.0, false, false},
             "auxiliary reservoir above the pipe from which the valve fills the cylinder");
    v.Number("lap_kpa", lap_kpa, Range{0.0, 50.0, false, false},
             "auxiliary reservoir above the pipe below which it ends that");
    v.Number("release_kpa", release_kpa, Range{0.5, 100.0, false, false},
             "pipe above the auxiliary reservoir from which the valve releases");
    v.Number("emergency_reservoir_l", emergency_reservoir_l, Range{1.0, 1000.0, false, false},
             "volume of the emergency reservoir: 3500 in3 [M]");
    v.Number("quick_service_volume_l", quick_service_volume_l, Range{0.0, 10.0, false, false},
             "volume that takes air from the pipe at each first application [A]");
    v.Number("quick_service_kpa", quick_service_kpa, Range{0.0, 300.0, false, false},
             "pressure of that volume at which it takes no more [A]");
    v.Number("quick_service_opening_mm", quick_service_opening_mm, Range{0.1, 10.0, false, false},
             "opening through which it takes it [A]");
    v.Number("minimum_cylinder_kpa", minimum_cylinder_kpa, Range{0.0, 200.0, false, false},
             "cylinder pressure up to which an application fills from the pipe [M]");
    v.Number("limiting_opening_mm", limiting_opening_mm, Range{0.0, 5.0, false, false},
             "opening through which it does [A]");
    v.Number("emergency_opening_mm", emergency_opening_mm, Range{0.5, 25.0, false, false},
             "opening from the emergency reservoir to the cylinder [A]");
    v.Number("vent_opening_mm", vent_opening_mm, Range{0.0, 30.0, false, false},
             "opening from the pipe to the atmosphere in an emergency");
    v.Number("quick_action_time_s", quick_action_time_s, Range{0.05, 10.0, false, false},
             "tau_q, time constant of the chamber that follows the pipe [A]");
    v.Number("quick_action_threshold_kpa", quick_action_threshold_kpa, Range{1.0, 200.0, false, false},
             "d_em, lead of that chamber over the pipe that begins an emergency [A]");
    v.Number("vent_closes_below_kpa", vent_closes_below_kpa, Range{0.0, 300.0, false, false},
             "pressure of the pipe below which the vent of an emergency may close");
    v.Number("vent_time_s", vent_time_s, kNonNegative, "time before which it does not close");
    v.Flag("accelerated_release", accelerated_release,
           "after an emergency, cylinder and auxiliary reservoir feed the pipe once it has been charged to "
           "accelerated_release_kpa");
    if (accelerated_release)
      v.Number("accelerated_release_kpa", accelerated_release_kpa, Range{10.0, 500.0, false, false},
               "pressure of the pipe at which that begins: 20 psi [M]");
    v.Check(lap_kpa < apply_kpa, "lap_kpa", "must be below apply_kpa", {"apply_kpa"});
  }
};

/// Graduated release, UIC distributor. With the control reservoir's pressure p_R,
///
///   goal = min(k (p_R - p_pipe), p_max)           k = ratio, p_max = maximum_cylinder_kpa
///   dp/dt = b (1.05 goal - p) up to the goal      b = ln(10.5) / fill_time_s: 95 % of any goal after fill_time_s
///   dp/dt = -b_r (p - goal) down to it            b_r = ln(0.95 p_max / 40 kPa) / release_time_s
///
/// First step: below 10 % of p_max the cylinder fills at p_max / 10 per second at least. It applies once the pipe is
/// insensitivity_kpa below p_R and releases once it is within release_kpa. While released, the pipe and p_R equalise
/// with control_time_s: slow changes of the pipe (0.5 kPa/s: 10 kPa) do not apply the brake. [M: UIC 540, EN 15355; A]
struct GraduatedReleaseParams {
  double ratio = 3.8 / 1.5;
  double maximum_cylinder_kpa = 380.0;
  double fill_time_s = 4.0;
  double release_time_s = 17.5;
  double insensitivity_kpa = 15.0;
  double release_kpa = 5.0;
  double control_time_s = 20.0;
  double quick_service_volume_l = 0.6;
  double quick_service_kpa = 35.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("ratio", ratio, Range{0.5, 10.0, false, false}, "k, cylinder pressure over the fall of the pipe");
    v.Number("maximum_cylinder_kpa", maximum_cylinder_kpa, Range{50.0, 1000.0, false, false},
             "p_max, largest cylinder pressure");
    v.Number("fill_time_s", fill_time_s, Range{0.5, 100.0, false, false},
             "to 95 % of the goal; P: 3 to 5 s; G: 18 to 30 s");
    v.Number("release_time_s", release_time_s, Range{0.5, 200.0, false, false},
             "from 95 % to 40 kPa; P: 15 to 20 s; G: 45 to 60 s");
    v.Number("insensitivity_kpa", insensitivity_kpa, Range{1.0, 60.0, false, false},
             "fall of the pipe below the control reservoir from which the brake applies");
    v.Number("release_kpa", release_kpa, Range{0.5, 60.0, false, false},
             "fall of the pipe below the control reservoir under which the brake releases");
    v.Number("control_time_s", control_time_s, Range{1.0, 1000.0, false, false},
             "time constant with which pipe and control reservoir equalise while released");
    v.Number("quick_service_volume_l", quick_service_volume_l, Range{0.0, 10.0, false, false},
             "volume of the accelerating chamber, which takes air from the pipe");
    v.Number("quick_service_kpa", quick_service_kpa, Range{0.0, 300.0, false, false},
             "pressure of that chamber at which it takes no more");
    v.Check(release_kpa < insensitivity_kpa, "release_kpa", "must be below insensitivity_kpa", {"insensitivity_kpa"});
  }
};

/// ECP. The goal is a share of full service of maximum_cylinder_kpa, sent to all vehicles at once; the cylinder follows
/// it as a distributor's does, with the times below. A pipe below emergency_pipe_kpa is an emergency, whatever is sent.
struct EcpParams {
  double maximum_cylinder_kpa = 430.0;
  double delay_s = 0.2;
  double fill_time_s = 10.0;
  double emergency_fill_time_s = 8;
  double release_time_s = 15.0;
  double emergency_pipe_kpa = 345.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("maximum_cylinder_kpa", maximum_cylinder_kpa, Range{50.0, 1000.0, false, false},
             "cylinder pressure of a full application");
    v.Number("delay_s", delay_s, Range{0.0, 10.0, false, false}, "from the driver's command to the valve [A]");
    v.Number("fill_time_s", fill_time_s, Range{0.5, 100.0, false, false}, "to 95 % of the goal [A]");
    v.Number("emergency_fill_time_s", emergency_fill_time_s, Range{0.5, 100.0, false, false},
             "the same in an emergency [A]");
    v.Number("release_time_s", release_time_s, Range{0.5, 200.0, false, false}, "from 95 % to 40 kPa");
    v.Number("emergency_pipe_kpa", emergency_pipe_kpa, Range{0.0, 1000.0, false, false},
             "pressure of the pipe below which there is an emergency, whatever is sent: 50 psi [M]");
  }
};

/// The control valve of a vehicle, with its reservoirs and its cylinder.
struct ControlValveParams {
  std::string name;
  ControlValveKind kind = ControlValveKind::kDirectRelease;
  double auxiliary_reservoir_l = 41.0;
  double cylinder_l = 16.4;
  double charging_opening_mm = 3.2;
  double application_opening_mm = 2.4;
  double exhaust_opening_mm = 3.2;
  double cylinder_leakage_kpa_per_min = 0.0;
  double ep_vent_opening_mm = 0.0;
  DirectReleaseParams direct;
  GraduatedReleaseParams graduated;
  EcpParams ecp;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name by which equipment chooses the valve");
    v.Choice("kind", kind,
             {{"direct_release", ControlValveKind::kDirectRelease},
              {"graduated_release", ControlValveKind::kGraduatedRelease},
              {"ecp", ControlValveKind::kEcp}},
             "direct_release: AAR AB type, a rise of the pipe releases fully; graduated_release: UIC "
             "distributor; ecp: electronically controlled, the pipe only feeds");
    v.Number("auxiliary_reservoir_l", auxiliary_reservoir_l, Range{1.0, 1000.0, false, false},
             "volume of the auxiliary reservoir: 2500 in3 [S]");
    v.Number("cylinder_l", cylinder_l, Range{0.5, 200.0, false, false},
             "volume of cylinder, clearance and piping at working travel, constant: 41.0 / 2.5 [A]");
    v.Number("charging_opening_mm", charging_opening_mm, Range{0.5, 25.0, false, false},
             "opening from the pipe to the reservoirs, with check valve");
    v.Number("cylinder_leakage_kpa_per_min", cylinder_leakage_kpa_per_min, Range{0.0, 1000.0, false, false},
             "fall of the cylinder's pressure by leakage");
    if (kind == ControlValveKind::kDirectRelease) {
      v.Number("application_opening_mm", application_opening_mm, Range{0.5, 25.0, false, false},
               "opening from the auxiliary reservoir to the cylinder [A]");
      v.Number("exhaust_opening_mm", exhaust_opening_mm, Range{0.5, 25.0, false, false},
               "opening from the cylinder to the atmosphere [A]");
      v.Group("direct", direct, "thresholds and chambers of direct release");
    }
    if (kind == ControlValveKind::kGraduatedRelease)
      v.Group("graduated", graduated, "thresholds and times of graduated release");
    if (kind == ControlValveKind::kEcp)
      v.Group("ecp", ecp, "times and pressures of the electronically controlled brake");
    if (kind != ControlValveKind::kEcp)
      v.Number("ep_vent_opening_mm", ep_vent_opening_mm, Range{0.0, 10.0, false, false},
               "electro-pneumatic assistance: opening through which each vehicle vents its pipe; 0: none");
  }
};

/// What a valve does.
enum class ControlValveMode {
  kRelease,
  kApply,
  kLap,
  kEmergency,
  kBailedOff  ///< of direct release: lap, with the cylinder open to the atmosphere
};

/// The air of one vehicle's brake, the pipe excluded; pressures absolute.
struct ControlValveState {
  double auxiliary_pa, emergency_pa, cylinder_pa;
  double quick_service_pa;     ///< in the quick-service volume, or accelerating chamber
  double quick_action_pa;      ///< p_q of the quick-action chamber, or p_R of the control reservoir
  double quick_action_gap_pa;  ///< p_q less pipe at the last step
  double vent_open_s;          ///< for which the emergency vent has been open
  double mode;                 ///< a ControlValveMode

  template <class Function>
  void ForEachField(Function&& function) {
    function(auxiliary_pa), function(emergency_pa), function(cylinder_pa), function(quick_service_pa);
    function(quick_action_pa), function(quick_action_gap_pa), function(vent_open_s), function(mode);
  }
  ControlValveMode Mode() const { return static_cast<ControlValveMode>(static_cast<int>(mode)); }
  void SetMode(ControlValveMode m) { mode = static_cast<double>(static_cast<int>(m)); }
};

/// Setting of a retaining valve.
enum class Retainer { kDirect, kHighPressure, kLowPressure, kSlowDirect };

/// What the train line sends to every connected valve.
struct TrainLine {
  double ecp_goal = 0.0;       ///< share of full service, 0 ... 1
  bool ecp_emergency = false;  ///< the goal is an emergency's
  double ep_pipe_pa = 1e9;     ///< target pressure of the pipe, absolute; electro-pneumatic assistance only
  bool ep_emergency = false;
};

/// A control valve ready to step: constants of its parameters, the temperature and the step.
///
/// Direct release, by mode, with hysteresis: see Step() in the source, a case per mode. An emergency is a rate:
///
///   dp_q/dt = (p_pipe - p_q) / tau_q;   fires when p_q - p_pipe > d_em: a steady fall below d_em / tau_q never does
///
/// The moment of firing is found inside the step (the gap taken as linear over it), and the vent is open for the rest.
/// Left out: friction and travel of pistons, the cylinder's volume over its travel, temperature.
class ControlValve {
 public:
  ControlValve(const ControlValveParams& params, double temperature_k, double dt_s);

  /// Charged, or with no more air than the atmosphere.
  ControlValveState Charged(double pipe_pa) const;
  ControlValveState Empty() const;

  /// One step over the pipe's pressure at the vehicle. @return p V let out to the atmosphere [J]
  ///
  /// @param pipe_pa  of the vehicle's cell, of volume pipe_m3; changed by what the valve takes or vents
  double Step(const TrainLine& line, Retainer retainer, ControlValveState& s, double& pipe_pa, double pipe_m3) const;

  /// A step of a bail-off, before Step: releases a locomotive's brake while that of the train stays applied. @return p
  /// V let out to the atmosphere [J]
  ///
  /// Direct release empties the cylinder, and keeps it empty until the pipe falls further or rises; an emergency fills
  /// it again when the handle is released. Graduated release lowers its control reservoir to the pipe's pressure, and
  /// so releases in its release time; so does ECP while the handle is held.
  double BailOff(ControlValveState& s, double pipe_pa) const;

  /// p V of all air that the state holds [J].
  double PressureVolume(const ControlValveState& s) const;

  const ControlValveParams& params() const { return p_; }

 private:
  double StepDirect(Retainer retainer, ControlValveState& s, double& pipe_pa, double pipe_m3) const;
  double StepGraduated(ControlValveState& s, double& pipe_pa, double pipe_m3) const;
  double StepEcp(const TrainLine& line, ControlValveState& s, double& pipe_pa, double pipe_m3) const;
  /// Moves the cylinder towards a goal (gauge); air from the auxiliary reservoir. @return p V let out
  double Follow(double goal_pa, double fill_per_s, double release_per_s, double least_fill_pa_per_s,
                ControlValveState& s) const;

  ControlValveParams p_;
  double dt_s_;
  double auxiliary_m3_, emergency_m3_, cylinder_m3_, quick_service_m3_;
  // conductance times R T [m3/s]
  double charging_, application_, exhaust_, slow_direct_, emergency_, vent_, limiting_, ep_vent_, quick_service_;
  double chamber_share_;  ///< of the gap that the chamber closes in a step: 1 - exp(-dt / tau)
  double leak_pa_;        ///< of the cylinder in a step
  double fill_per_s_, emergency_fill_per_s_, release_per_s_;
};

}  // namespace train_dynamics
