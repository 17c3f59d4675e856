#include "train_sim/brake_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "train_console/console.h"
#include "train_dynamics/brake/pneumatic/air_test.h"
#include "train_dynamics/brake/pneumatic/emergency_search.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/braked_weight.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_run/train_run.h"
#include "train_sim/run_command.h"

namespace train_sim {
namespace {

using train_dynamics::BrakeSystemKind;
using train_dynamics::Consist;
using train_dynamics::ScenarioParams;
using train_dynamics::config::LoadedScenario;

LoadedScenario LoadWithPneumaticBrake(const std::string& file, const std::vector<std::string>& overrides) {
  LoadedScenario loaded = train_dynamics::config::LoadScenario(file, overrides);
  const ScenarioParams& params = loaded.params;
  if (!params.pressure_table.empty() || !params.brake || params.brake->kind != BrakeSystemKind::kPneumatic)
    throw std::invalid_argument(file + ": brake.kind must be pneumatic for this command; try --set brake=ab_head_end");
  return loaded;
}

std::vector<double> Lengths(const Consist& consist) {
  std::vector<double> length_m;
  length_m.reserve(consist.vehicles());
  for (int i = 0; i < consist.vehicles(); ++i) length_m.push_back(consist.vehicle(i).length_m);
  return length_m;
}

/// Random service commands at several cell counts: a line of the table for each, and what led to an emergency.
void Search(const train_dynamics::PneumaticBrakeParams& brake, const std::vector<double>& length_m, int trials,
            std::uint32_t seed, std::vector<train_dynamics::AirTestResult>& results, std::string& undesired) {
  for (const int cells : {1, 2, 4, 8}) {
    train_dynamics::EmergencySearch search;
    search.trials = trials;
    search.seed = seed;
    search.cells_per_vehicle = cells;
    const auto found = train_dynamics::FindUndesiredEmergencies(brake, length_m, search);
    results.push_back({fmt::format("random service commands, {} cell(s): emergencies", cells),
                       static_cast<double>(found.size()), fmt::format("of {}", trials), "none [A]", found.empty()});
    for (const train_dynamics::UndesiredEmergency& e : found) {
      undesired += fmt::format("\n{} cell(s), trial {}: vehicle {} at {:.2f} s, pipe at first {:.1f} kPa, after", cells,
                               e.trial, e.vehicle, e.time_s, e.initial_pressure_kpa);
      for (const train_dynamics::BrakeCommand& c : e.commands) {
        undesired += c.kind == train_dynamics::BrakeCommandKind::kApply
                         ? fmt::format(" {:.3f} s: {:.3f} kPa,", c.time_s, c.reduction_kpa)
                         : fmt::format(" {:.3f} s: release,", c.time_s);
      }
      undesired.back() = '\n';
    }
  }
}

/// Distance [m] of the train's middle from the emergency's command to its stop, on level track.
double StoppingDistance(ScenarioParams params, double speed_kmh) {
  params.model = train_dynamics::VehicleModel::kLtd;
  for (auto& group : params.train.consist) group.model.reset();
  params.detail_vehicles.clear();
  params.track.grades.clear();
  train_dynamics::DriverCommand emergency;
  emergency.time_s = 0.0;
  emergency.kind = train_dynamics::DriverCommandKind::kEmergency;
  params.commands = {emergency};
  params.initial_speed_kmh = speed_kmh;
  params.duration_s = 600.0;
  params.dt_s = params.exchange_interval_s = 0.001;
  params.record_interval_s = 0.05;
  params.ledger_interval_s = 600.0;
  const Consist consist(params.train);
  train_dynamics::InProcessTransport transport(params, consist, 1);
  train_run::TrainRun run(params, consist, transport, MakeBrakeSystem(params, consist));
  double distance_m = 0.0;
  bool stands = false;
  run.AddObserver([&](const train_dynamics::TrainRecord& record) {
    distance_m = record.mean_position_m - record.at_time_zero.mean_position_m;
    stands = record.exchange > 0 && record.mean_speed_mps < 0.01;
  });
  train_run::RunHooks hooks;
  hooks.ends = [&stands] { return stands; };
  run.Go(hooks);
  if (!run.fault().empty()) throw std::runtime_error(run.fault());
  if (!stands) throw std::invalid_argument("does not stop within 600 s: is its brake too weak?");
  return distance_m;
}

/// One vehicle of the last group, with its brake.
ScenarioParams Alone(ScenarioParams params) {
  auto& consist = params.train.consist;
  const int vehicles = params.train.VehicleCount();
  consist = {consist.back()};
  consist[0].count = consist[0].vehicles_per_unit = 1;
  auto& brake = params.brake->pneumatic;
  brake.valves = {brake.valves[brake.ValveOfVehicle(vehicles).back()]};
  brake.equipment.clear();
  brake.closed_angle_cocks.clear();
  brake.parted_hoses.clear();
  brake.sources.resize(1);
  brake.sources[0].vehicle = 1;
  return params;
}

}  // namespace

int PrintAirTest(const std::string& scenario_file, const std::vector<std::string>& overrides, int trials,
                 std::uint32_t seed) {
  const LoadedScenario loaded = LoadWithPneumaticBrake(scenario_file, overrides);
  const std::vector<double> length_m = Lengths(loaded.consist);
  for (const std::string& warning : loaded.warnings) train_console::Tell("warning: {}\n", warning);
  auto results = train_dynamics::TestAirBrake(loaded.params.brake->pneumatic, length_m);
  std::string undesired;
  if (trials > 0) Search(loaded.params.brake->pneumatic, length_m, trials, seed, results, undesired);
  train_console::Print("{}: air brake of {} vehicles\n\n{:<52} {:>9} {:<8} {:<46} {}\n", loaded.params.brake->name,
                       length_m.size(), "test", "value", "", "rule", "");
  int failed = 0;
  for (const train_dynamics::AirTestResult& r : results) {
    train_console::Print("{:<52} {:>9} {:<8} {:<46} {}\n", r.test,
                         std::isnan(r.value) ? "never" : fmt::format("{:.4g}", r.value), r.unit, r.rule,
                         r.passed ? "passed" : "FAILED");
    failed += !r.passed;
  }
  train_console::Print("{}", undesired);
  train_console::Print("\n{} of {} passed\n", results.size() - failed, results.size());
  return failed == 0 ? train_run::kSuccess : train_run::kFailure;
}

int PrintBrakeWeight(const std::string& scenario_file, const std::vector<std::string>& overrides) {
  const LoadedScenario loaded = LoadWithPneumaticBrake(scenario_file, overrides);
  const ScenarioParams alone = Alone(loaded.params);
  train_console::Print("{}\n\nalone: {}, {:.1f} t\n", loaded.params.name, alone.train.consist[0].vehicle.name,
                       1e-3 * alone.train.consist[0].vehicle.TotalMass());
  double lambda = 0.0;
  for (const double speed_kmh : {120.0, 100.0}) {
    const double stop_m = StoppingDistance(alone, speed_kmh);
    lambda = train_dynamics::BrakedWeightPercentage(speed_kmh, stop_m);
    train_console::Print("  from {:g} km/h: {:.1f} m, braked weight {:.1f} % (UIC 544-1)\n", speed_kmh, stop_m, lambda);
  }
  double train_m = 0.0;
  for (const double length_m : Lengths(loaded.consist)) train_m += length_m;
  const auto& pneumatic = loaded.params.brake->pneumatic;
  const auto& valve = pneumatic.valves[pneumatic.ValveOfVehicle(loaded.consist.vehicles()).back()];
  const bool goods =
      valve.kind == train_dynamics::ControlValveKind::kGraduatedRelease && valve.graduated.fill_time_s > 10.0;
  const double stop_m = StoppingDistance(loaded.params, 100.0);
  const double model_m = train_dynamics::EtcsStoppingDistance(
      lambda, train_m, 100.0,
      goods ? train_dynamics::BrakingPosition::kGoods : train_dynamics::BrakingPosition::kPassenger);
  const double difference = stop_m / model_m - 1.0;
  const bool agrees = std::abs(difference) <= 0.1;
  train_console::Print(
      "train: {} vehicles, {:.0f} m, position {}\n  from 100 km/h: {:.1f} m; conversion model of ETCS {:.1f} "
      "m: {:+.1f} %, {}\n",
      loaded.consist.vehicles(), train_m, goods ? "G" : "P", stop_m, model_m, 100.0 * difference,
      agrees ? "within 10 %" : "FAILED: more than 10 %");
  return agrees ? train_run::kSuccess : train_run::kFailure;
}

}  // namespace train_sim
