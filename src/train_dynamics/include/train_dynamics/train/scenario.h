#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/train/consist.h"
#include "train_dynamics/train/driver_command.h"
#include "train_dynamics/train/driver_params.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/vehicle_model.h"
#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {

/// A braking scenario: a train on a track under a list of driver commands. All that a run depends on.
struct ScenarioParams {
  std::string name;
  std::string description;
  VehicleModel model = VehicleModel::kTwoD;
  TrainParams train;
  TrackParams track;
  std::string pressure_table;
  std::optional<BrakeSystemParams> brake;
  std::vector<DriverCommand> commands;
  std::optional<BuiltInDriverParams> driver;
  double initial_speed_kmh = kRequired;
  double initial_reduction_kpa = 0.0;
  double start_position_m = 0.0;
  SlackState initial_slack = SlackState::kStretched;
  double duration_s = kRequired;
  std::optional<ConditionParams> until;
  double dt_s = 0.001;
  double exchange_interval_s = 0.001;
  double record_interval_s = 0.01;
  double ledger_interval_s = 1.0;
  LtdIntegrator integrator = LtdIntegrator::kLeapfrog;
  bool adhesion_limit = true;
  std::vector<int> detail_vehicles;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the scenario, for people");
    v.Text("description", description, "what the scenario shows");
    v.Choice("model", model, kVehicleModels,
             "of the groups of vehicles that name none: 2d: bodies, suspension, wheel-rail contact in the "
             "plane; ltd: one mass with rotating inertia; ltd-no-inertia: one mass");
    v.Part("train", train, "trains", "the train");
    v.Part("track", track, "tracks", "the track; not given: level and straight");
    v.Text("pressure_table", pressure_table,
           "CSV file with the cylinder pressure of each vehicle over time; not given: brake computes them");
    v.Part("brake", brake, "brakes", "brake system, which computes the pressures from the driver's commands");
    v.List("commands", commands, "what the driver does, and when");
    v.Group("driver", driver, "built-in driver, who holds a speed or the limits and stops at places");
    v.Check(brake || !pressure_table.empty(), "brake", "must be given, or else a pressure_table");
    v.Number("initial_speed_kmh", initial_speed_kmh, Range{-400.0, 400.0, false, false},
             "speed of the train at time 0; negative: backwards");
    v.Number("initial_reduction_kpa", initial_reduction_kpa, kNonNegative,
             "of the brake pipe at time 0, long since applied: cylinders have its pressure; 0: released");
    v.Number("start_position_m", start_position_m, kFinite,
             "position of the first vehicle's centre along the track at time 0");
    v.Choice("initial_slack", initial_slack, kSlackStates, "where the slack of all connections is at time 0");
    v.Number("duration_s", duration_s, Range{0.0, 1e6},
             "simulated time at which the run ends; a multiple of record_interval_s");
    v.Group("until", until, "condition that ends the run earlier, at the next record");
    v.Number("dt_s", dt_s, Range{1e-6, 0.1, false, false}, "time step");
    v.Number("exchange_interval_s", exchange_interval_s, kPositive,
             "time between exchanges of forces and pressures, a multiple of dt_s");
    v.Number("record_interval_s", record_interval_s, kPositive,
             "time between records, a multiple of exchange_interval_s");
    v.Number("ledger_interval_s", ledger_interval_s, kPositive,
             "time between energy ledgers, a multiple of record_interval_s");
    v.Choice("integrator", integrator, {{"leapfrog", LtdIntegrator::kLeapfrog}, {"newmark", LtdIntegrator::kNewmark}},
             "of LTD vehicles");
    v.Flag("adhesion_limit", adhesion_limit,
           "of LTD vehicles: the rail gives at most mu0 W (2D vehicles always have this limit)");
    v.Integers("detail_vehicles", detail_vehicles, Range{-100000, 100000, false, false},
               "vehicles recorded in full detail, from 1, or from -1 for the last");
    v.Check(Multiple(exchange_interval_s, dt_s), "exchange_interval_s", "must be a multiple of dt_s", {"dt_s"});
    v.Check(Multiple(record_interval_s, exchange_interval_s), "record_interval_s",
            "must be a multiple of exchange_interval_s", {"exchange_interval_s"});
    v.Check(Multiple(ledger_interval_s, record_interval_s), "ledger_interval_s",
            "must be a multiple of record_interval_s", {"record_interval_s"});
    v.Check(Multiple(duration_s, record_interval_s), "duration_s", "must be a multiple of record_interval_s",
            {"record_interval_s"});
    v.Check(integrator == LtdIntegrator::kLeapfrog || !Uses(VehicleModel::kTwoD), "integrator",
            "must be leapfrog for the 2d model: explicit creep forces are unstable",
            {"model", "train.consist[].model"});
    train_dynamics::Check(BrokenRules(), v);
  }

  int StepsPerExchange() const;
  long Exchanges() const;
  int ExchangesPerRecord() const;
  int RecordsPerLedger() const;
  /// External vehicles count as LTD: one mass, without wheels.
  VehicleModel ModelOfGroup(std::size_t group) const {
    const ConsistGroupParams& of = train.consist[group];
    return of.external.empty() ? of.model.value_or(model) : VehicleModel::kLtd;
  }
  bool Uses(VehicleModel model) const;              ///< for any group
  std::vector<VehicleModel> VehicleModels() const;  ///< [vehicle]
  /// The names of the models of the train's groups, each once: "2d", or "2d, ltd".
  std::string ModelNames() const;
  /// The same with vehicles of the ltd model in place of external ones.
  ScenarioParams WithBuiltInVehicles() const;
  /// Indices of the vehicles recorded in full detail, ascending, each once: those of the 2D model.
  std::vector<int> DetailedVehicles() const;
  /// Initial speed of the vehicles of a group [m/s].
  double InitialSpeedOfGroup(std::size_t group) const {
    return train.consist[group].initial_speed_kmh.value_or(initial_speed_kmh) / 3.6;
  }
  /// Initial speed of the vehicles' momentum [m/s].
  double MeanInitialSpeed() const;

 private:
  static bool Multiple(double whole, double part);
  std::vector<BrokenRule> BrokenRules() const;
  void JudgeNodes(std::vector<BrokenRule>& broken) const;
  void JudgeTimes(std::vector<BrokenRule>& broken) const;
  void JudgeBrake(std::vector<BrokenRule>& broken) const;
  void JudgeDriver(std::vector<BrokenRule>& broken) const;
  void JudgeDips(std::vector<BrokenRule>& broken) const;
  void JudgeSlideProtection(std::vector<BrokenRule>& broken) const;
};

/// The rule on the group that a command of locomotives names, with the existing names.
std::string RuleOfGroup(const DriverCommand& command, const TrainParams& train);

/// The brake system of a scenario that must have one.
/// @throws std::invalid_argument if it does not suit the train
BrakeSystem MakeBrakeSystem(const ScenarioParams& scenario, const Consist& consist);

}  // namespace train_dynamics
