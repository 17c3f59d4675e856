#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/train/run_summary.h"
#include "train_dynamics/train/train_master.h"
#include "train_results/run_output.h"
#include "train_run/exit_code.h"

namespace train_run {

/// Results could not be written. The text says which and why.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the owner of a run decides between two exchanges.
struct RunHooks {
  /// Called before each exchange; true ends the run there.
  std::function<bool()> ends = [] { return false; };
  /// Whether the next exchange may begin now. If not, it has waited a moment, and is called again after `ends`.
  std::function<bool()> admits = [] { return true; };
  /// Called right before each exchange, also between an interruption and its checkpoint: the place to call Command.
  std::function<void()> begins = [] {};
  /// Called after each exchange, with its wall time [s], unless it is empty.
  std::function<void(double)> exchanged;
  /// Called once in each turn of the loop, whether or not there was an exchange.
  std::function<void()> turned = [] {};
};

/// A run of a train, once: from time 0 or from a checkpoint, exchange by exchange, to its end or to an interruption.
/// Keeps its summary, feeds its results and leaves its checkpoints.
class TrainRun {
 public:
  /// Keeps references: all but the brake must outlive the run.
  /// @param from    the checkpoint from which it is resumed; null: it begins at time 0
  /// @param output  its results; null: none are written
  TrainRun(const train_dynamics::ScenarioParams& scenario, const train_dynamics::Consist& consist,
           train_dynamics::Transport& transport, train_dynamics::BrakeSystem brake,
           const train_dynamics::TrainCheckpoint* from = nullptr, train_results::RunOutput* output = nullptr);

  /// Called for every record, after the summary and the results have received it.
  void AddObserver(train_dynamics::TrainMaster::Observer observer) { master_.AddObserver(std::move(observer)); }

  /// Runs until the end, or until `hooks.ends`; then, if checkpoints are kept, on to the next record with a checkpoint
  /// there, for at most `patience` of wall time.
  ///
  /// A fault of the simulation or of the results ends the run and is kept (see fault, write_error); other exceptions,
  /// of the transport, pass through. Call Finish in either case.
  void Go(const RunHooks& hooks, std::chrono::duration<double> patience = std::chrono::hours(24));

  /// Completes the results. @param fault  why the run ended, where it is not one that Go has kept
  /// @return the summary as JSON
  std::string Finish(double wall_s, const std::string& fault = "");
  /// Warnings for the user after the run: a route that was left, and, for a complete run, commands that were never
  /// given.
  std::vector<std::string> Warnings() const;

  /// See TrainMaster::Command; between two exchanges.
  void Command(const train_dynamics::DriverCommand& command) { master_.Command(command); }

  /// See TrainMaster::View; between two exchanges.
  const train_dynamics::DriverView& View(double ahead_m, bool is_shown_couplers) {
    return master_.View(ahead_m, is_shown_couplers);
  }

  const train_dynamics::TrainMaster& master() const { return master_; }
  const train_dynamics::RunSummary& summary() const { return summary_; }
  /// See RunSummary::SetTwin.
  void SetTwin(train_dynamics::TwinRun twin) { summary_.SetTwin(std::move(twin)); }
  /// When it begins [s]: later than 0 if it is resumed from a checkpoint.
  double start_s() const;
  /// Whether Go has been interrupted, and continues only to the next record.
  bool ending() const { return ending_; }
  /// Why the simulation broke down; empty: it did not.
  const std::string& fault() const { return fault_; }
  /// Why the results could not be written; empty: they could.
  const std::string& write_error() const { return write_error_; }
  ExitCode exit_code() const;

 private:
  void Begin();
  void Loop(const RunHooks& hooks);
  void LeaveCheckpoint(const RunHooks& hooks, std::chrono::duration<double> patience);
  /// One exchange, with its checkpoint where one is due or `wanted`. @return whether there was one
  bool Exchange(const RunHooks& hooks, bool wanted);

  const train_dynamics::ScenarioParams& scenario_;
  const train_dynamics::TrainCheckpoint* from_;
  train_results::RunOutput* output_;
  train_dynamics::TrainMaster master_;
  train_dynamics::RunSummary summary_;
  bool ending_ = false;
  std::string fault_, write_error_;
};

}  // namespace train_run
