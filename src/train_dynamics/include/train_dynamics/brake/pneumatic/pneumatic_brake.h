#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/brake/brake_command.h"
#include "train_dynamics/brake/pneumatic/brake_record.h"
#include "train_dynamics/brake/pneumatic/control_valve.h"
#include "train_dynamics/brake/pneumatic/pipe_flow.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// The brake pipe of a train.
struct TrainPipeParams {
  double inner_diameter_mm = 31.75;
  double length_ratio = 1.10;
  double branch_volume_l = 0.9;
  double temperature_k = 293.15;
  double leakage_g_per_s_km = 0.0;
  int cells_per_vehicle = 2;
  double longest_step_ms = 5.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("inner_diameter_mm", inner_diameter_mm, Range{20.0, 50.0, false, false},
             "inner diameter of the brake pipe: 1.25 in, AAR [S]; 32 mm UIC");
    v.Number("length_ratio", length_ratio, Range{1.0, 1.3, false, false},
             "length of the pipe over that of the vehicle [S]");
    v.Number("branch_volume_l", branch_volume_l, Range{0.0, 20.0, false, false},
             "volume of the branch pipe of each vehicle [A]");
    v.Number("temperature_k", temperature_k, Range{223.0, 323.0, false, false}, "temperature of the air, constant");
    v.Number("leakage_g_per_s_km", leakage_g_per_s_km, Range{0.0, 1000.0, false, false},
             "leakage of the charged pipe per km of it; proportional to the gauge pressure");
    v.Integer("cells_per_vehicle", cells_per_vehicle, Range{1, 1000, false, false},
              "number of volumes by which each vehicle's pipe is computed");
    v.Number("longest_step_ms", longest_step_ms, Range{0.01, 5.0, false, false},
             "longest time step of the pipe and its valves; halved until half a cell is left to a wave");
  }
};

/// The driver's valve, and that of every remote locomotive.
struct DriversValveParams {
  double service_rate_kpa_per_s = 20.0;
  double full_service_reduction_kpa = 170.0;
  double main_reservoir_kpa = 900.0;
  double charging_opening_mm = 19.0;
  double exhaust_opening_mm = 25.0;
  double emergency_opening_mm = 25.0;
  double blocking_time_s = 60.0;
  bool pressure_maintaining = true;
  double overcharge_kpa = 0.0;
  double overcharge_time_s = 10.0;
  double overcharge_decay_kpa_per_s = 0.3;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("service_rate_kpa_per_s", service_rate_kpa_per_s, Range{10.0, 40.0, false, false},
             "rate at which the equalising reservoir falls in a service application");
    v.Number("full_service_reduction_kpa", full_service_reduction_kpa, Range{50.0, 400.0, false, false},
             "reduction of full service, of which ECP and electro-pneumatic goals are shares");
    v.Number("main_reservoir_kpa", main_reservoir_kpa, Range{300.0, 1200.0, false, false},
             "pressure of the main reservoir, constant: the compressors keep up [A]");
    v.Number("charging_opening_mm", charging_opening_mm, Range{1.0, 40.0, false, false},
             "opening through which the pipe is charged [A]");
    v.Number("exhaust_opening_mm", exhaust_opening_mm, Range{1.0, 40.0, false, false},
             "opening through which a service application vents the pipe [A]");
    v.Number("emergency_opening_mm", emergency_opening_mm, Range{15.0, 32.0, false, false},
             "opening through which an emergency vents the pipe [A]");
    v.Number("blocking_time_s", blocking_time_s, kNonNegative, "time for which nothing ends an emergency [A]");
    v.Flag("pressure_maintaining", pressure_maintaining, "whether an applied brake's pipe is fed against leakage");
    v.Number("overcharge_kpa", overcharge_kpa, Range{0.0, 100.0, false, false},
             "pressure above the charged one that a release gives the pipe");
    v.Number("overcharge_time_s", overcharge_time_s, kNonNegative, "how long it holds");
    v.Number("overcharge_decay_kpa_per_s", overcharge_decay_kpa_per_s, Range{0.01, 10.0, false, false},
             "rate at which it then falls");
  }
};

enum class PipeSourceKind { kDriver, kRemote, kEndOfTrain };

/// A place where the pipe is charged and vented.
struct PipeSourceParams {
  std::string name;
  int vehicle = 1;
  PipeSourceKind kind = PipeSourceKind::kDriver;
  double radio_delay_s = 0.0;
  bool two_way = true;
  double opening_mm = 19.0;
  std::optional<double> radio_lost_from_s;  ///< none: the radio is never lost
  std::optional<double> radio_lost_to_s;    ///< none: it does not come back
  std::vector<BrakeCommand> commands;

  /// Whether a command given at that time does not arrive.
  bool RadioIsLost(double time_s) const {
    return kind != PipeSourceKind::kDriver && radio_lost_from_s && time_s >= *radio_lost_from_s &&
           (!radio_lost_to_s || time_s < *radio_lost_to_s);
  }

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the source, for people");
    v.Integer("vehicle", vehicle, Range{-100000, 100000, false, false},
              "vehicle that has the source: 1 the first, -1 the last");
    v.Choice("kind", kind,
             {{"driver", PipeSourceKind::kDriver},
              {"remote", PipeSourceKind::kRemote},
              {"end_of_train", PipeSourceKind::kEndOfTrain}},
             "driver: the leading locomotive; remote: a locomotive by radio (distributed power); "
             "end_of_train: a device that vents in an emergency");
    if (kind != PipeSourceKind::kDriver) {
      v.Number("radio_delay_s", radio_delay_s, Range{0.0, 600.0, false, false},
               "from the driver's command to its arrival here");
      v.Number("radio_lost_from_s", radio_lost_from_s, kNonNegative,
               "commands given from here on, up to radio_lost_to_s, do not arrive; not given: the radio is "
               "never lost");
      v.Number("radio_lost_to_s", radio_lost_to_s, kNonNegative,
               "end of the loss of radio; not given: it does not come back. A remote locomotive's valve laps "
               "45 s after "
               "its beginning [A]");
      v.Check(!radio_lost_to_s || radio_lost_from_s, "radio_lost_to_s", "needs radio_lost_from_s",
              {"radio_lost_from_s"});
      v.Check(!radio_lost_to_s || !radio_lost_from_s || *radio_lost_to_s > *radio_lost_from_s, "radio_lost_to_s",
              "must be > radio_lost_from_s", {"radio_lost_from_s"});
    }
    if (kind == PipeSourceKind::kEndOfTrain) {
      v.Flag("two_way", two_way, "whether the device vents in an emergency; false: it only reports");
      v.Number("opening_mm", opening_mm, Range{5.0, 32.0, false, false}, "opening of the device's vent [A]");
    }
    if (kind == PipeSourceKind::kRemote)
      v.List("commands", commands, "commands of this locomotive alone, in place of the driver's: independent control");
    v.Check(vehicle != 0, "vehicle", "must count from 1, or from -1 for the last");
  }
};

enum class EmptyLoad { kNone, kTwoStep, kProportional };

/// Brake equipment that only some vehicles have.
struct BrakeEquipmentParams {
  int from = kRequiredInteger;
  int to = kRequiredInteger;
  std::string valve;
  bool cut_out = false;
  Retainer retainer = Retainer::kDirect;
  EmptyLoad empty_load = EmptyLoad::kNone;
  double load_share = 1.0;
  double empty_ratio = 0.5;
  double change_over_share = 0.4;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Integer("from", from, Range{-100000, 100000, false, false}, "first vehicle, from 1; or from -1 for the last");
    v.Integer("to", to, Range{-100000, 100000, false, false}, "last vehicle, likewise");
    v.Text("valve", valve, "name of one of valves; not given: the first");
    v.Flag("cut_out", cut_out, "the vehicles' valves are cut out");
    v.Choice("retainer", retainer,
             {{"direct", Retainer::kDirect},
              {"high_pressure", Retainer::kHighPressure},
              {"low_pressure", Retainer::kLowPressure},
              {"slow_direct", Retainer::kSlowDirect}},
             "retaining valve: direct: open; high_pressure, low_pressure: keep pressure in the cylinder; "
             "slow_direct: releases slowly");
    v.Choice(
        "empty_load", empty_load,
        {{"none", EmptyLoad::kNone}, {"two_step", EmptyLoad::kTwoStep}, {"proportional", EmptyLoad::kProportional}},
        "none; two_step: empty_ratio below change_over_share of the load; proportional: with the load");
    v.Number("load_share", load_share, kFraction, "how much of the full load the vehicles carry");
    v.Number("empty_ratio", empty_ratio, Range{0.1, 1.0, false, false}, "cylinder's pressure, empty over loaded");
    v.Number("change_over_share", change_over_share, kFraction,
             "share of the load below which a two_step device is set to empty");
  }
  /// Share of the cylinder pressure that acts on the shoes [-].
  double PressureShare() const;
};

/// A hose that parts.
struct PartedHoseParams {
  int behind_vehicle = kRequiredInteger;
  double time_s = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Integer("behind_vehicle", behind_vehicle, Range{1, 100000, false, false},
              "vehicle behind which the hose parts, from 1");
    v.Number("time_s", time_s, kNonNegative, "when it parts");
  }
};

/// The air brake of a train as a machine. Pressures are gauge.
struct PneumaticBrakeParams {
  double charged_pressure_kpa = 600.0;
  std::optional<double> initial_pressure_kpa;
  TrainPipeParams pipe;
  DriversValveParams drivers_valve;
  std::vector<PipeSourceParams> sources{PipeSourceParams{}};
  std::vector<ControlValveParams> valves{ControlValveParams{}};
  std::vector<BrakeEquipmentParams> equipment;
  std::vector<int> closed_angle_cocks;
  std::vector<PartedHoseParams> parted_hoses;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("charged_pressure_kpa", charged_pressure_kpa, Range{300.0, 1000.0, false, false},
             "gauge pressure of the charged brake pipe");
    v.Number("initial_pressure_kpa", initial_pressure_kpa, Range{0.0, 1000.0, false, false},
             "pressure of pipe and reservoirs at time 0; not given: charged");
    v.Group("pipe", pipe, "the brake pipe of the train");
    v.Group("drivers_valve", drivers_valve, "the driver's valve, and that of every remote locomotive");
    v.List("sources", sources, "places where the pipe is charged and vented; the first is of kind driver");
    v.List("valves", valves, "control valves of the vehicles; the first is that of all for which equipment names none");
    v.List("equipment", equipment, "what some vehicles have that others have not");
    v.Integers("closed_angle_cocks", closed_angle_cocks, Range{1, 100000, false, false},
               "vehicles behind which an angle cock of the pipe is closed, from 1");
    v.List("parted_hoses", parted_hoses, "hoses that part");
    v.Check(drivers_valve.main_reservoir_kpa >= charged_pressure_kpa + drivers_valve.overcharge_kpa,
            "drivers_valve.main_reservoir_kpa", "must be at least charged_pressure_kpa and the overcharge",
            {"charged_pressure_kpa"});
    v.Check(!sources.empty() && sources.front().kind == PipeSourceKind::kDriver, "sources",
            "must begin with a source of kind driver");
    v.Check(!valves.empty(), "valves", "must list at least one valve");
  }

  /// The rules that are broken in a train of this many vehicles.
  std::vector<BrokenRule> BrokenRules(const std::vector<BrakeCommand>& commands, int vehicles) const;
  std::vector<Warning> Warnings(const std::vector<BrakeCommand>& commands, int vehicles) const;
  bool ReleasesGradually() const;
  /// Of each vehicle: the index of its valve.
  std::vector<int> ValveOfVehicle(int vehicles) const;
};

/// Commands in transmission to a source, which obeys each as soon as its radio has delivered it.
struct CommandsUnderWay {
  static constexpr int kMost = 8;
  struct Entry {
    double arrives_s, kind, reduction_pa;
  };
  std::array<Entry, kMost> entries{};
  double count = 0.0;

  template <class Function>
  void ForEachField(Function&& function) {
    for (Entry& entry : entries) function(entry.arrives_s), function(entry.kind), function(entry.reduction_pa);
    function(count);
  }
};

/// Commanded state of a driver's valve or of the train line.
struct SourceState {
  CommandsUnderWay under_way;
  double goal_pa;        ///< of the equalising reservoir, gauge
  double equalising_pa;  ///< gauge
  double emergency;      ///< 1 or 0
  double emergency_from_s;
  double overcharged_to_s;
  double flow_kgps;   ///< into the pipe; negative: out of it
  double own_obeyed;  ///< how many of its own commands have been sent

  template <class Function>
  void ForEachField(Function&& function) {
    under_way.ForEachField(function);
    function(goal_pa), function(equalising_pa), function(emergency), function(emergency_from_s);
    function(overcharged_to_s), function(flow_kgps), function(own_obeyed);
  }
};

/// The brake pipe of a train with its valves, stepped on a fixed grid of times t_k = k dt, dt <= 5 ms and at most half
/// the time in which a wave crosses a cell, whatever times are queried. In a step: commands that have arrived, the air
/// in the pipe, leakage, sources, valves in vehicle order. Cylinder pressures between two grid times are linear.
///
/// Left out: temperature; the locomotives' compressors; hand brakes; piston travel over wear.
class PneumaticBrake {
 public:
  /// @param vehicle_length_m  of each vehicle, front to rear, > 0
  /// @param commands  the driver's, times ascending; others may come by Command()
  /// @throws std::invalid_argument if a parameter does not suit the train; names it
  PneumaticBrake(const PneumaticBrakeParams& params, const std::vector<double>& vehicle_length_m,
                 std::vector<BrakeCommand> commands = {});

  int vehicles() const { return static_cast<int>(states_.size()); }
  double step_s() const { return dt_s_; }

  /// Adds a command of the driver; times of commands ascend.
  void Command(const BrakeCommand& command);
  /// The hose parts between vehicles `connection` and `connection` + 1, from 0. A second call has no effect.
  void OpenPipe(double time_s, int connection);
  /// The valve of a vehicle is cut out, before the first step, with this pressure in its cylinder and none elsewhere.
  void TrapAir(int vehicle, double pressure_pa);
  /// Holds the valve of a vehicle, between two times, where it empties its cylinder; see ControlValve::BailOff.
  void BailOff(int vehicle, double from_s, double to_s) { bail_offs_.push_back({vehicle, from_s, to_s}); }

  /// Acting pressure of each vehicle's cylinder [Pa, gauge]; resizes `pressure_pa`. Times must ascend.
  void PressuresAt(double time_s, std::vector<double>& pressure_pa);

  template <class Function>
  void ForEachField(Function&& function) {
    for (double& p : flow_.pressure_pa) function(p);
    for (double& m : flow_.mass_flow_kgps) function(m);
    for (ControlValveState& s : states_) s.ForEachField(function);
    for (SourceState& s : sources_) s.ForEachField(function);
    line_.ForEachField(function);
    for (double& p : acting_pa_) function(p);
    for (double& p : acting_before_pa_) function(p);
    function(steps_), function(supplied_pv_), function(released_pv_), function(given_);
  }

  /// What is recorded of each vehicle, at the last grid time; resizes.
  void Record(BrakeRecordArrays& record) const;

  // The same one by one, and of the train; pressures gauge [Pa].
  double time_s() const { return steps_ * dt_s_; }
  double PipePressure(int vehicle) const { return flow_.pressure_pa[valve_cell_[vehicle]] - kAtmospherePa; }
  const ControlValveState& valve(int vehicle) const { return states_[vehicle]; }
  ControlValveState& valve(int vehicle) { return states_[vehicle]; }
  const SourceState& source(int i) const { return sources_[i]; }
  double HeadPressure() const { return flow_.pressure_pa.front() - kAtmospherePa; }
  double TailPressure() const { return flow_.pressure_pa.back() - kAtmospherePa; }
  double PipeLength() const;
  double FlowIntoPipe() const;  ///< of all sources [kg/s]

  /// Air in pipe, reservoirs and cylinders [kg]; what sources have supplied; what has left for the atmosphere.
  double AirMass() const;
  double SuppliedMass() const { return supplied_pv_ / grid_.rt; }
  double ReleasedMass() const { return released_pv_ / grid_.rt; }

 private:
  void Step();
  void StepSource(int i);
  void Receive(SourceState& source, double now_s) const;
  void Send(SourceState& source, double now_s, double delay_s, const BrakeCommand& command) const;
  void Equalise(SourceState& source, double now_s) const;

  PneumaticBrakeParams params_;
  PipeGrid grid_;
  double dt_s_;
  std::vector<ControlValve> valves_;
  std::vector<int> valve_of_, valve_cell_, source_cell_;
  std::vector<char> cut_out_;
  std::vector<Retainer> retainer_;
  std::vector<double> pressure_share_;
  std::vector<double> leak_share_;  ///< [cell] of the gauge pressure, per step
  double charging_, exhaust_, emergency_, bore_;
  double line_delay_s_ = 0.0;
  bool all_ecp_ = true, has_line_ = false;

  PipeFlow flow_;
  std::vector<ControlValveState> states_;
  std::vector<SourceState> sources_;
  SourceState line_{};
  std::vector<double> acting_pa_, acting_before_pa_;
  std::vector<int> parted_;  ///< faces
  struct HeldOff {
    int vehicle;
    double from_s, to_s;
  };
  std::vector<HeldOff> bail_offs_;
  std::vector<BrakeCommand> commands_;
  double given_ = 0.0;  ///< of commands_
  double steps_ = 0.0, supplied_pv_ = 0.0, released_pv_ = 0.0;
};

}  // namespace train_dynamics
