#include "train_sim/run_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/run_summary.h"
#include "train_dynamics/train/thread_team.h"
#include "train_results/resume.h"
#include "train_results/run_output.h"
#include "train_run/interrupt.h"
#include "train_run/progress.h"

namespace train_sim {
namespace {

using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;

void Print(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

std::vector<std::string> Overrides(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.model.empty()) overrides.push_back("model=" + options.model);
  return overrides;
}

LoadedScenario Load(const RunOptions& options) {
  LoadedScenario scenario = train_dynamics::config::LoadScenario(options.scenario, Overrides(options));
  Print(scenario.warnings);
  return scenario;
}

}  // namespace

int Threads(int asked, const LoadedScenario& scenario) {
  return train_dynamics::UsefulThreads(scenario.params, 0, scenario.consist.vehicles(),
                                       asked > 0 ? asked : train_dynamics::UsableCores());
}

namespace {

/// From time 0, or from a checkpoint, to the end.
int Run(const LoadedScenario& scenario, const RunOptions& options,
        const train_dynamics::TrainCheckpoint* checkpoint, train_results::RunOutput& output) {
  train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist,
                                              Threads(options.threads, scenario));
  train_dynamics::TrainMaster master(scenario.params, scenario.consist, vehicles, scenario.pressures);
  train_dynamics::RunSummary summary(scenario.params);
  const double start_s =
      checkpoint == nullptr ? 0.0
                            : scenario.params.exchange_interval_s * static_cast<double>(checkpoint->exchange);
  train_run::Progress progress(scenario.params.duration_s, start_s);
  master.AddObserver([&](const TrainRecord& record) { summary.Observe(record); });
  master.AddObserver([&](const TrainRecord& record) { output.Record(record); });
  master.AddObserver([&](const TrainRecord& record) { progress.Show(record.time_s, record.mean_speed_mps); });

  std::string fault, write_error;
  try {
    if (checkpoint == nullptr) {
      master.Start();
    } else {
      summary.SetMemory(checkpoint->summary);
      master.Resume(*checkpoint);
    }
    // Interrupted, it goes on to the next record, of which there can be a checkpoint.
    for (bool ending = false; !master.Done() && !ending;) {
      const bool interrupted = train_run::Interrupt() != 0;
      ending = interrupted && master.RecordIsNext();
      const bool leaves_checkpoint = output.AskForCheckpoint(master, interrupted);
      master.Exchange();
      if (leaves_checkpoint) output.KeepCheckpoint(master, summary);
    }
  } catch (const train_dynamics::SimulationFault& e) {
    fault = e.what();
  } catch (const std::exception& e) {  // of a recorder
    write_error = e.what();
  }
  progress.Finish();

  const std::string json = summary.Json(master, progress.WallSeconds(), fault);
  try {
    output.Finish(master, json);
  } catch (const std::exception& e) {
    write_error = e.what();
  }
  fmt::print("{}", json);
  if (!write_error.empty()) {
    fmt::print(stderr, "train_sim: the results could not be written at {:.3f} s: {} (is the disk full?)\n",
               master.time_s(), write_error);
    return train_run::kFailure;
  }
  if (!fault.empty()) {
    fmt::print(stderr, "train_sim: the simulation broke down: {}\n", fault);
    return train_run::kSimulationFault;
  }
  if (!master.Done()) {
    fmt::print(stderr, "train_sim: interrupted at {:.3f} s of {:g} s\n", master.time_s(),
               scenario.params.duration_s);
    return train_run::kInterrupted;
  }
  return train_run::kSuccess;
}

}  // namespace

int RunScenario(const RunOptions& options) {
  train_run::CatchInterrupts();  // before there are files that only an orderly end completes
  const train_results::OutputOptions output_options = {
      options.out,
      true,
      options.csv,
      options.checkpoint_interval_s,
      options.go_on_without_records ? train_results::OnWriteError::kGoOn : train_results::OnWriteError::kStop,
      [](const std::string& what) { fmt::print(stderr, "\ntrain_sim: {}\n", what); }};
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
