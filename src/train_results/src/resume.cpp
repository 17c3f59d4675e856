#include "train_results/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "strict_config/writer.h"
#include "train_dynamics/numeric/stream_digest.h"
#include "train_results/conversions.h"
#include "train_results/plain_file.h"

namespace train_results {
namespace {

namespace fs = std::filesystem;
using train_dynamics::ScenarioParams;
using train_dynamics::config::LoadedScenario;

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 30;  // [bytes], of 1.8 million wagons

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// The first line in which two texts differ, as "'now', was 'then'".
std::string FirstDifference(const std::string& now, const std::string& then) {
  std::istringstream a(now), b(then);
  std::string line_now, line_then;
  while (true) {
    const bool has_now = static_cast<bool>(std::getline(a, line_now));
    const bool has_then = static_cast<bool>(std::getline(b, line_then));
    if (!has_now && !has_then) return "nothing";
    if (!has_now) line_now = "(end)";
    if (!has_then) line_then = "(end)";
    if (line_now != line_then) return fmt::format("'{}', was '{}'", line_now, line_then);
  }
}

/// The commands that the driver has given by then, as text.
std::string CommandsUntil(double time_s, const ScenarioParams& scenario) {
  std::string text;
  for (const train_dynamics::DriverCommand& command : scenario.commands) {
    if (command.time_s.value_or(0.0) > time_s) continue;
    text += fmt::format("({}: {}) ", command.time_s ? fmt::format("{:g} s", *command.time_s) : "on a condition",
                        command.Text());
  }
  return text.empty() ? "none" : text.substr(0, text.size() - 1);
}

/// Checks that the past is unchanged: the structure and time grid of the state, the start, and the driver's commands so
/// far.
void CheckBranch(const LoadedScenario& now, const LoadedScenario& then, double time_s) {
  const auto keep = [](const char* key, const auto& value, const auto& was) {
    if (value == was) return;
    throw std::invalid_argument(fmt::format("{} must stay {} when a run is resumed, got {}", key, was, value));
  };
  const ScenarioParams &p = now.params, &q = then.params;
  keep("model", std::string(ModelName(p.model)), std::string(ModelName(q.model)));
  keep("dt_s", p.dt_s, q.dt_s);
  keep("exchange_interval_s", p.exchange_interval_s, q.exchange_interval_s);
  keep("record_interval_s", p.record_interval_s, q.record_interval_s);
  keep("ledger_interval_s", p.ledger_interval_s, q.ledger_interval_s);
  keep("the number of vehicles", now.consist.vehicles(), then.consist.vehicles());
  if (p.VehicleModels() != q.VehicleModels()) {
    throw std::invalid_argument("the model of every vehicle must stay as it is when a run is resumed");
  }
  if (p.DetailedVehicles() != q.DetailedVehicles()) {
    throw std::invalid_argument("detail_vehicles must stay as they are when a run is resumed");
  }
  keep("initial_speed_kmh", p.initial_speed_kmh, q.initial_speed_kmh);
  for (std::size_t i = 0; i < std::min(p.train.consist.size(), q.train.consist.size()); ++i) {
    keep(fmt::format("the initial speed of train.consist[{}] in m/s", i).c_str(), p.InitialSpeedOfGroup(i),
         q.InitialSpeedOfGroup(i));
  }
  keep("initial_reduction_kpa", p.initial_reduction_kpa, q.initial_reduction_kpa);
  if (p.driver.has_value() != q.driver.has_value())
    throw std::invalid_argument("driver must be given, or not, as it was when a run is resumed");
  keep("start_position_m", p.start_position_m, q.start_position_m);
  if (p.initial_slack != q.initial_slack) {
    throw std::invalid_argument("initial_slack must stay as it is when a run is resumed");
  }
  keep(fmt::format("commands up to {:g} s", time_s).c_str(), CommandsUntil(time_s, p), CommandsUntil(time_s, q));
  if (p.integrator != q.integrator) {
    throw std::invalid_argument("integrator must stay as it is when a run is resumed");
  }
}

}  // namespace

train_dynamics::TrainCheckpoint ReadCheckpoint(const fs::path& file) {
  if (!fs::exists(file)) {
    throw std::invalid_argument(file.string() +
                                " does not exist: the run has left no checkpoint, or it is no folder of a run");
  }
  const std::string content = ReadPlainFile(file, kLargestFile);
  try {
    return train_dynamics::DecodeTrainCheckpoint({content.begin(), content.end()});
  } catch (const train_dynamics::SnapshotError& e) {
    throw std::invalid_argument(file.string() + " " + e.what());
  }
}

std::string IdentityOf(const ScenarioParams& scenario) {
  ScenarioParams named = scenario;
  if (!scenario.pressure_table.empty()) {
    train_dynamics::StreamDigest digest;
    const std::string table = ReadPlainFile(scenario.pressure_table, kLargestFile);
    digest.Add(table.data(), table.size());
    named.pressure_table = fmt::format("XXH64 {:016x}", digest.value());
  }
  return VersionLine() + "\n" + strict_config::Write(named);
}

ResumedRun LoadResumedRun(const fs::path& folder, const std::vector<std::string>& overrides) {
  const fs::path config = folder / "config.yaml";
  train_dynamics::TrainCheckpoint checkpoint = ReadCheckpoint(folder / kCheckpointFile);
  LoadedScenario then = train_dynamics::config::LoadScenario(config.string(), {});
  const std::string identity = IdentityOf(then.params);
  if (FirstLine(checkpoint.scenario) != VersionLine()) {
    throw std::invalid_argument(fmt::format(
        "{} was written by '{}', this is '{}': other versions may give other bits. Finish the run with the "
        "version that began it, or run its config.yaml again",
        (folder / kCheckpointFile).string(), FirstLine(checkpoint.scenario).substr(2), VersionLine().substr(2)));
  }
  if (identity != checkpoint.scenario) {
    throw std::invalid_argument(fmt::format(
        "{} is of another configuration than {}: there is now {}. Undo that, or change values "
        "with --set: the "
        "result is then a run of its own",
        (folder / kCheckpointFile).string(), config.string(), FirstDifference(identity, checkpoint.scenario)));
  }
  LoadedScenario now = train_dynamics::config::LoadScenario(config.string(), overrides);
  const bool is_branch = IdentityOf(now.params) != identity;
  if (is_branch) CheckBranch(now, then, then.params.exchange_interval_s * static_cast<double>(checkpoint.exchange));
  if (static_cast<long>(checkpoint.exchange) >= now.params.Exchanges()) {
    throw std::invalid_argument(
        fmt::format("{} was taken at the end of the run, {:g} s: nothing is left to simulate; a larger "
                    "duration_s goes on",
                    (folder / kCheckpointFile).string(),
                    static_cast<double>(checkpoint.exchange) * now.params.exchange_interval_s));
  }
  return {folder, std::move(now), std::move(checkpoint), is_branch};
}

}  // namespace train_results
