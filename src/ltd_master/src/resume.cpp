#include "ltd_master/resume.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "train_dynamics/config/writer.h"
#include "train_dynamics/numeric/digest.h"

namespace ltd_master {
namespace {

namespace fs = std::filesystem;
using train_dynamics::ScenarioParams;
using train_dynamics::config::LoadedScenario;

std::string Content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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

void CheckBranch(const LoadedScenario& now, const LoadedScenario& then) {
  const auto keep = [](const char* key, const auto& value, const auto& was) {
    if (value == was) return;
    throw std::invalid_argument(
        fmt::format("{} must stay {} when a run is resumed, got {}", key, was, value));
  };
  const ScenarioParams &p = now.params, &q = then.params;
  keep("model", std::string(ModelName(p.model)), std::string(ModelName(q.model)));
  keep("dt_s", p.dt_s, q.dt_s);
  keep("exchange_interval_s", p.exchange_interval_s, q.exchange_interval_s);
  keep("record_interval_s", p.record_interval_s, q.record_interval_s);
  keep("ledger_interval_s", p.ledger_interval_s, q.ledger_interval_s);
  keep("the number of vehicles", now.consist.vehicles(), then.consist.vehicles());
  if (p.DetailedVehicles() != q.DetailedVehicles()) {
    throw std::invalid_argument("detail_vehicles must stay as they are when a run is resumed");
  }
  if (p.integrator != q.integrator) {
    throw std::invalid_argument("integrator must stay as it is when a run is resumed");
  }
}

}  // namespace

train_dynamics::TrainCheckpoint ReadCheckpoint(const fs::path& file) {
  if (!fs::exists(file)) {
    throw std::invalid_argument(
        file.string() + " does not exist: the run has left no checkpoint, or it is no folder of a run");
  }
  const std::string content = Content(file);
  try {
    return train_dynamics::DecodeTrainCheckpoint({content.begin(), content.end()});
  } catch (const train_dynamics::SnapshotError& e) {
    throw std::invalid_argument(file.string() + " " + e.what());
  }
}

std::string IdentityOf(const ScenarioParams& scenario) {
  ScenarioParams named = scenario;
  if (!scenario.pressure_table.empty()) {
    named.pressure_table =
        fmt::format("digest {:016x}", train_dynamics::TextDigest(Content(scenario.pressure_table)));
  }
  return train_dynamics::config::Write(named);
}

ResumedRun LoadResumedRun(const fs::path& folder, const std::vector<std::string>& overrides) {
  const fs::path config = folder / "config.yaml";
  train_dynamics::TrainCheckpoint checkpoint = ReadCheckpoint(folder / kCheckpointFile);
  LoadedScenario then = train_dynamics::config::LoadScenario(config.string(), {});
  const std::string identity = IdentityOf(then.params);
  if (identity != checkpoint.scenario) {
    throw std::invalid_argument(
        fmt::format("{} is of another configuration than {}: there is now {}. Undo that, or change values "
                    "with --set: the "
                    "result is then a run of its own",
                    (folder / kCheckpointFile).string(), config.string(),
                    FirstDifference(identity, checkpoint.scenario)));
  }
  LoadedScenario now = train_dynamics::config::LoadScenario(config.string(), overrides);
  const bool is_branch = IdentityOf(now.params) != identity;
  if (is_branch) CheckBranch(now, then);
  if (static_cast<long>(checkpoint.exchange) >= now.params.Exchanges()) {
    throw std::invalid_argument(
        fmt::format("{} is of the end of the run, {:g} s: nothing is left to do; a larger duration_s goes on",
                    (folder / kCheckpointFile).string(),
                    static_cast<double>(checkpoint.exchange) * now.params.exchange_interval_s));
  }
  return {folder, std::move(now), std::move(checkpoint), is_branch};
}

}  // namespace ltd_master
