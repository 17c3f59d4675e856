#include "train_sim/check_command.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "strict_config/writer.h"
#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/exchange_stability.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/thread_team.h"
#include "train_sim/run_command.h"
#include "train_sim/run_prediction.h"

namespace train_sim {
namespace {

using train_dynamics::ConnectionParams;
using train_dynamics::ScenarioParams;
using train_dynamics::VehicleModel;
using train_dynamics::config::LoadedScenario;

constexpr double kMs = 1e3, kMega = 1e-6;

template <class... Values>
void Line(const char* name, const char* format, const Values&... values) {
  train_console::Print("  {:<10} {}\n", name, fmt::format(fmt::runtime(format), values...));
}

double FreeMemory() {
  return static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Of the file system on which a folder is, or will be. @return infinity if unknown
double FreeSpace(const std::filesystem::path& folder) {
  std::filesystem::path above = std::filesystem::absolute(folder);
  while (!std::filesystem::exists(above) && above.has_relative_path()) above = above.parent_path();
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(above, error);
  return error ? std::numeric_limits<double>::infinity() : static_cast<double>(space.available);
}

/// The connections between vehicles, and the longest stable exchange of each kind.
std::string ConnectionLimits(const LoadedScenario& scenario) {
  const double head_kg = LightestCouplerHead(scenario.params);
  std::vector<std::string> limits;
  for (const int type : scenario.consist.connection_type) {
    const ConnectionParams& connection = scenario.consist.connection_types[type];
    const bool depends_on_force =
        std::visit([](const auto& law) { return law.TangentAt(train_dynamics::kLargeCouplerForce).depends_on_force; },
                   connection.Law());
    const std::string limit =
        fmt::format("{} stable to {:.3g} ms{}", connection.name, kMs * LongestStableExchange(connection, head_kg),
                    depends_on_force ? " at 900 kN" : "");
    if (std::find(limits.begin(), limits.end(), limit) == limits.end()) limits.push_back(limit);
  }
  return fmt::format("{}", fmt::join(limits, ", "));
}

/// To two digits, never as 5.7e+02.
std::string TwoDigits(double value) {
  return value < 100.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// Its name, and where it is known.
std::string TrackText(const train_dynamics::TrackParams& track) {
  const train_dynamics::Stretch known = track.Extent();
  const std::string name = track.name.empty() ? "without a name" : track.name;
  if (!std::isfinite(known.from_m) || !std::isfinite(known.to_m)) return name;
  return fmt::format("{}, {:.3f} km to {:.3f} km", name, 1e-3 * known.from_m, 1e-3 * known.to_m);
}

void PrintScenario(const LoadedScenario& scenario) {
  const ScenarioParams& p = scenario.params;
  const train_dynamics::Consist& consist = scenario.consist;
  double mass = 0.0, length = 0.0;
  for (int i = 0; i < consist.vehicles(); ++i) {
    mass += consist.vehicle(i).TotalMass();
    length += consist.vehicle(i).length_m;
  }
  const auto draw_bars = std::count_if(consist.connection_type.begin(), consist.connection_type.end(), [&](int type) {
    return consist.connection_types[type].kind == train_dynamics::ConnectionKind::kDrawBar;
  });
  const double steps = static_cast<double>(p.Exchanges()) * p.StepsPerExchange();
  train_console::Print("{}{}{}\n", p.name, p.description.empty() ? "" : ": ", p.description);
  Line("model", "{}", p.ModelNames());
  Line("train", "{}: {} vehicle(s), {:.0f} t, {:.1f} m; {} couplers, {} draw-bars", p.train.name, consist.vehicles(),
       1e-3 * mass, length, static_cast<long>(consist.connection_type.size()) - draw_bars, draw_bars);
  for (const train_dynamics::Rank& rank : train_dynamics::ExternalRanks(p.train))
    Line("external", "{}, moved by the node {}", VehiclesText(rank), rank.name);
  Line("track", "{}", TrackText(p.track));
  if (p.pressure_table.empty()) {
    Line("pressures", "{}, {} driver command(s)", p.brake->name, p.commands.size());
  } else {
    Line("pressures", "{}", p.pressure_table);
  }
  Line("run", "{:g} s from {:g} km/h, {:g} steps of {:g} s, exchange every {:g} s, record every {:g} s", p.duration_s,
       3.6 * p.MeanInitialSpeed(), steps, p.dt_s, p.exchange_interval_s, p.record_interval_s);
}

void PrintStability(const LoadedScenario& scenario) {
  const ScenarioParams& p = scenario.params;
  for (const auto& [vehicle, step_s] : scenario.stable_steps) {
    Line("step", "{:g} ms; {} stable to {:.4g} ms", kMs * p.dt_s, vehicle, kMs * step_s);
  }
  if (scenario.consist.connection_type.empty()) return;
  // docs/validation.md: changes of the largest coupler forces against exchanges of 1 ms, as long as they are stable.
  constexpr double kErrorPerS = 1.3e6;  // [N/s]
  Line("exchange", "{:g} ms; {}; it changes the paper's coupler forces by up to {:.2g} kN", kMs * p.exchange_interval_s,
       ConnectionLimits(scenario), 1e-3 * kErrorPerS * p.exchange_interval_s);
}

void WarnOfRun(const CheckOptions& options, const RunPrediction& run, std::vector<std::string>& warnings) {
  if (!run.fault.empty()) {
    warnings.push_back(fmt::format("{}: broke down in the trial: {}", options.scenario, run.fault));
  }
  if (run.memory_bytes > FreeMemory()) {
    warnings.push_back(
        fmt::format("{}: the train needs {:.0f} MB of memory, {:.0f} MB are free; take a shorter train or "
                    "more machines",
                    options.scenario, kMega * run.memory_bytes, kMega * FreeMemory()));
  }
  if (!options.out.empty() && run.bag_bytes > FreeSpace(options.out)) {
    warnings.push_back(
        fmt::format("--out {}: the bag needs {:.0f} MB, {:.0f} MB are free; take a longer "
                    "record_interval_s, fewer detail_vehicles or another disk",
                    options.out, kMega * run.bag_bytes, kMega * FreeSpace(options.out)));
  }
}

/// Reasons against this number of wagon nodes; all machines are assumed to be like this one.
void WarnOfNodes(const CheckOptions& options, int vehicles, std::vector<std::string>& warnings) {
  const auto warn = [&](const std::string& text) {
    warnings.push_back(fmt::format("--nodes {}: {}", options.nodes, text));
  };
  if (options.nodes > vehicles) {
    warn(fmt::format("the train has {} vehicles; take at most as many nodes", vehicles));
  }
  const int per_machine = (options.nodes + options.machines - 1) / options.machines,
            cores = train_dynamics::UsableCores();
  if (per_machine > cores) {
    constexpr double kCoreTime = 90e-6;  // [s] of a node's exchange: 10.9 ms for 242 on two cores (docs/lockstep.md)
    warn(
        fmt::format("{} nodes share {} cores, so that an exchange takes about {:.2g} ms; {} nodes are fastest, or more "
                    "machines",
                    per_machine, cores, kMs * kCoreTime * per_machine / cores, cores * options.machines));
  }
  constexpr double kNodeMemory = 1.2e6;  // private, docs/lockstep.md
  if (kNodeMemory * per_machine > FreeMemory()) {
    warn(fmt::format("{:.0f} MB of memory are needed on a machine, {:.0f} MB are free here; take fewer nodes",
                     kMega * kNodeMemory * per_machine, kMega * FreeMemory()));
  }
  const auto exceeds = [](auto resource, double needed) {
    rlimit limit{};
    return getrlimit(resource, &limit) == 0 && limit.rlim_max != RLIM_INFINITY &&
           needed > static_cast<double>(limit.rlim_max);
  };
  constexpr double kFilesPerNode = 2.0, kOtherFiles = 256.0, kThreadsPerNode = 5.0;
  if (exceeds(RLIMIT_NOFILE, kFilesPerNode * options.nodes + kOtherFiles)) {
    warn(fmt::format("the master needs {:g} open files, more than `ulimit -Hn`; raise that or take fewer nodes",
                     kFilesPerNode * options.nodes + kOtherFiles));
  }
  if (exceeds(RLIMIT_NPROC, kThreadsPerNode * per_machine)) {
    warn(fmt::format("{:g} threads on a machine are more than `ulimit -Hu`; raise that or take fewer nodes",
                     kThreadsPerNode * per_machine));
  }
}

}  // namespace

namespace {

/// The values of a scenario for other programs; units are in the names.
std::string Json(const LoadedScenario& scenario, const RunPrediction& run, const std::vector<std::string>& warnings) {
  const ScenarioParams& p = scenario.params;
  double mass_kg = 0.0, length_m = 0.0;
  for (int i = 0; i < scenario.consist.vehicles(); ++i) {
    mass_kg += scenario.consist.vehicle(i).TotalMass();
    length_m += scenario.consist.vehicle(i).length_m;
  }
  nlohmann::ordered_json external = nlohmann::ordered_json::array(), connections = external;
  for (const train_dynamics::Rank& rank : train_dynamics::ExternalRanks(p.train)) {
    const train_dynamics::VehicleParams& vehicle = scenario.consist.vehicle(rank.first);  // all of a group are equal
    external.push_back({{"node", rank.name},
                        {"first_vehicle", rank.first + 1},
                        {"vehicles", rank.count},
                        {"group", scenario.consist.vehicle_type[rank.first]},
                        {"mass_kg", vehicle.TotalMass()},
                        {"length_m", vehicle.length_m},
                        {"speed_mps", p.InitialSpeedOfGroup(scenario.consist.vehicle_type[rank.first])}});
  }
  for (const ConnectionParams& connection : scenario.consist.connection_types) {
    const train_dynamics::ConnectionTangent tangent =
        std::visit([](const auto& law) { return law.TangentAt(train_dynamics::kLargeCouplerForce); }, connection.Law());
    connections.push_back({{"name", connection.name},
                           {"stiffness_n_per_m", tangent.stiffness_n_per_m},
                           {"damping_ns_per_m", tangent.damping_ns_per_m}});
  }
  const nlohmann::ordered_json json = {{"version", TRAIN_BRAKE_VERSION},
                                       {"scenario", p.name},
                                       {"description", p.description},
                                       {"model", p.ModelNames()},
                                       {"default_model", train_dynamics::ModelName(p.model)},
                                       {"train", p.train.name},
                                       {"vehicles", scenario.consist.vehicles()},
                                       {"mass_kg", mass_kg},
                                       {"length_m", length_m},
                                       {"external", external},
                                       {"connections", connections},
                                       {"track", p.track.name},
                                       {"duration_s", p.duration_s},
                                       {"dt_s", p.dt_s},
                                       {"exchange_interval_s", p.exchange_interval_s},
                                       {"record_interval_s", p.record_interval_s},
                                       {"memory_bytes", run.memory_bytes},
                                       {"bag_bytes", run.bag_bytes},
                                       {"warnings", warnings}};
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

int ResolveScenario(const std::string& scenario, const std::vector<std::string>& overrides) {
  const LoadedScenario loaded = train_dynamics::config::LoadScenario(scenario, overrides);
  for (const std::string& warning : loaded.warnings) train_console::Tell("warning: {}\n", warning);
  train_console::Print("{}", strict_config::Write(loaded.params));
  return 0;
}

int CheckScenario(const CheckOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.model.empty()) overrides.push_back("model=" + options.model);
  const LoadedScenario scenario = train_dynamics::config::LoadScenario(options.scenario, overrides);
  const ScenarioParams& params = scenario.params;
  const int threads = Threads(options.threads, scenario);
  LoadedScenario built_in = scenario;  // external vehicles as ours would take them
  built_in.params = params.WithBuiltInVehicles();
  const RunPrediction run = PredictRun(built_in, threads);

  std::vector<std::string> warnings = scenario.warnings;
  WarnOfRun(options, run, warnings);
  if (options.json) {
    if (options.nodes > 0 && params.Uses(VehicleModel::kTwoD))
      WarnOfNodes(options, scenario.consist.vehicles(), warnings);
    train_console::Print("{}\n", Json(scenario, run, warnings));
    return run.fault.empty() ? train_run::kSuccess : train_run::kSimulationFault;
  }
  PrintScenario(scenario);
  PrintStability(scenario);
  Line("wall time", "about {} s with {} thread(s), {} x real time", TwoDigits(run.wall_s), threads,
       TwoDigits(params.duration_s / run.wall_s));
  Line("memory", "about {:.0f} MB", kMega * run.memory_bytes);
  Line("bag", "{:.1f} MB, {:.2f} MB per second", kMega * run.bag_bytes, kMega * run.bag_bytes / params.duration_s);
  if (options.nodes > 0 && !params.Uses(VehicleModel::kTwoD)) {
    warnings.push_back(
        fmt::format("--nodes {}: the {} model runs in the master; leave it out", options.nodes, params.ModelNames()));
  } else if (options.nodes > 0) {
    WarnOfNodes(options, scenario.consist.vehicles(), warnings);
    const TrafficPrediction traffic = PredictTraffic(scenario, std::min(options.nodes, scenario.consist.vehicles()));
    const double share = 1.0 / options.machines;
    Line("messages",
         "{:.0f} requests and as many replies per simulated second and machine, {:.1f} MB there, {:.1f} MB "
         "back",
         traffic.calls_per_s * share, kMega * traffic.bytes_to_nodes_per_s * share,
         kMega * traffic.bytes_from_nodes_per_s * share);
  }
  for (const std::string& warning : warnings) train_console::Tell("warning: {}\n", warning);
  if (!run.fault.empty()) return train_run::kSimulationFault;
  return train_run::kSuccess;
}

}  // namespace train_sim
