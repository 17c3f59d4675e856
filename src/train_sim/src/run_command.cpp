#include "train_sim/run_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/thread_team.h"
#include "train_results/plain_file.h"
#include "train_results/resume.h"
#include "train_results/run_output.h"
#include "train_results/summary_text.h"
#include "train_run/interrupt.h"
#include "train_run/progress.h"
#include "train_run/train_run.h"

namespace train_sim {
namespace {

using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;

void Print(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) train_console::Tell("warning: {}\n", warning);
}

std::vector<std::string> Overrides(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.model.empty()) overrides.push_back("model=" + options.model);
  return overrides;
}

LoadedScenario Load(const RunOptions& options) {
  LoadedScenario scenario = train_dynamics::config::LoadScenario(options.scenario, Overrides(options));
  Print(scenario.warnings);
  train_dynamics::InProcessTransport::RefuseExternal(scenario.params);
  return scenario;
}

}  // namespace

int Threads(int asked, const LoadedScenario& scenario) {
  return train_dynamics::UsefulThreads(scenario.params, 0, scenario.consist.vehicles(),
                                       asked > 0 ? asked : train_dynamics::UsableCores());
}

namespace {

/// The same run from a start that differs by a little, without any output. Empty if it is interrupted or breaks down.
std::optional<train_dynamics::TwinRun> RunTwin(const LoadedScenario& scenario, const RunOptions& options) {
  train_dynamics::ScenarioParams params = scenario.params;
  params.initial_speed_kmh += kTwinOffset;
  for (train_dynamics::ConsistGroupParams& group : params.train.consist) {
    if (group.initial_speed_kmh) *group.initial_speed_kmh += kTwinOffset;
  }
  train_dynamics::InProcessTransport vehicles(params, scenario.consist, Threads(options.threads, scenario));
  train_run::TrainRun run(params, scenario.consist, vehicles, scenario.pressures);
  train_run::RunHooks hooks;
  hooks.ends = [] { return train_run::Interrupt() != 0; };
  run.Go(hooks);
  if (run.exit_code() != train_run::kSuccess) return std::nullopt;
  return train_dynamics::TwinRun{kTwinOffset, run.master().in_train_forces().Extremes(),
                                 run.summary().mean_distance_m(), run.summary().mean_speed_mps()};
}

void WarnOfResidual(const train_run::TrainRun& run) {
  constexpr double kAim = 1e-6;
  const double share = run.summary().ResidualShare(run.master());
  if (std::abs(share) <= kAim) return;
  train_console::Tell(
      "warning: the energy ledger's residual is {:.2g} of the energy turned over, above {:.0e}: halve "
      "dt_s and "
      "exchange_interval_s and see what of the result stays\n",
      share, kAim);
}

/// The next steps for the user.
void TellWhereResultsAre(const RunOptions& options) {
  const std::string folder = train_console::ShellWord(options.out.empty() ? options.resume : options.out);
  if (options.out.empty() && options.resume.empty()) {
    train_console::Print("  nothing was written: --out FOLDER keeps the results\n");
  } else {
    train_console::Print("  results: {}   figures: rosrun train_brake report {}\n", folder, folder);
  }
}

/// From time 0, or from a checkpoint, to the end.
int Run(const LoadedScenario& scenario, const RunOptions& options, const train_dynamics::TrainCheckpoint* checkpoint,
        train_results::RunOutput& output) {
  train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, Threads(options.threads, scenario));
  train_run::TrainRun run(scenario.params, scenario.consist, vehicles, scenario.pressures, checkpoint, &output);
  train_run::Progress progress(scenario.params.duration_s, run.start_s());
  run.AddObserver([&](const TrainRecord& record) { progress.Show(record.time_s, record.mean_speed_mps); });
  train_run::RunHooks hooks;
  hooks.ends = [] { return train_run::Interrupt() != 0; };
  run.Go(hooks);
  progress.Finish();
  if (options.twin && run.exit_code() == train_run::kSuccess) {
    if (std::optional<train_dynamics::TwinRun> twin = RunTwin(scenario, options)) run.SetTwin(std::move(*twin));
  }
  WarnOfResidual(run);
  const std::string json = run.Finish(progress.WallSeconds());
  if (options.json) {
    train_console::Print("{}", json);
  } else {
    train_console::Print("{}", train_results::SummaryText(json));
    TellWhereResultsAre(options);
    if (run.exit_code() == train_run::kFailure) train_console::Print("{}", json);  // the result may exist nowhere else
  }
  Print(run.Warnings());
  const double end_s = run.master().time_s();
  switch (run.exit_code()) {
    case train_run::kFailure:
      train_console::Tell("train_sim: the results could not be written at {:.3f} s: {}\n", end_s, run.write_error());
      break;
    case train_run::kSimulationFault:
      train_console::Tell("train_sim: the simulation broke down: {}\n", run.fault());
      break;
    case train_run::kInterrupted:
      train_console::Tell("train_sim: interrupted at {:.3f} s of {:g} s\n", end_s, scenario.params.duration_s);
      break;
    default:
      break;
  }
  return run.exit_code();
}

}  // namespace

int TellSummary(const std::string& folder) {
  constexpr std::size_t kLargest = std::size_t{1} << 26U;
  const std::filesystem::path file = std::filesystem::path(folder) / "summary.json";
  try {
    train_console::Print("{}", train_results::SummaryText(train_results::ReadPlainFile(file, kLargest)));
  } catch (const train_results::NoSummary& e) {
    throw std::invalid_argument(file.string() + " is not the summary of a run: " + e.what());
  }
  return train_run::kSuccess;
}

int RunScenario(const RunOptions& options) {
  train_run::CatchInterrupts();  // before there are files that only an orderly end completes
  const train_results::OutputOptions output_options = {
      options.out,
      true,
      options.csv,
      options.checkpoint_interval_s,
      options.go_on_without_records ? train_results::OnWriteError::kGoOn : train_results::OnWriteError::kStop,
      [](const std::string& what) { train_console::Tell("\ntrain_sim: {}\n", what); }};
  if (options.resume.empty()) {
    const LoadedScenario scenario = Load(options);
    train_results::RunOutput output(output_options, scenario.files, scenario.params);
    return Run(scenario, options, nullptr, output);
  }
  const train_results::ResumedRun run = train_results::LoadResumedRun(options.resume, Overrides(options));
  Print(run.scenario.warnings);
  train_results::RunOutput output(output_options, run);
  return Run(run.scenario, options, &run.checkpoint, output);
}

}  // namespace train_sim
