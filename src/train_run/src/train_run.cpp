#include "train_run/train_run.h"

#include <utility>

#include "train_results/summary_json.h"

namespace train_run {
namespace {

using train_dynamics::TrainRecord;
using Clock = std::chrono::steady_clock;

/// Executes an action on the results. @throws WriteError for any failure
template <class Action>
void Write(const Action& action) {
  try {
    action();
  } catch (const std::exception& e) {
    throw WriteError(e.what());
  }
}

}  // namespace

TrainRun::TrainRun(const train_dynamics::ScenarioParams& scenario, const train_dynamics::Consist& consist,
                   train_dynamics::Transport& transport, train_dynamics::BrakeSystem brake,
                   const train_dynamics::TrainCheckpoint* from, train_results::RunOutput* output)
    : scenario_(scenario),
      from_(from),
      output_(output),
      master_(scenario, consist, transport, std::move(brake)),
      summary_(scenario) {
  master_.AddObserver([this](const TrainRecord& record) { summary_.Observe(record); });
  if (output_ == nullptr) return;
  master_.AddObserver([this](const TrainRecord& record) { Write([&] { output_->Record(record); }); });
}

double TrainRun::start_s() const {
  return from_ == nullptr ? 0.0 : scenario_.exchange_interval_s * static_cast<double>(from_->exchange);
}

void TrainRun::Go(const RunHooks& hooks, std::chrono::duration<double> patience) {
  try {
    Begin();
    Loop(hooks);
    ending_ = !master_.Done();
    if (ending_ && output_ != nullptr && master_.GivesCheckpoints()) LeaveCheckpoint(hooks, patience);
  } catch (const train_dynamics::SimulationFault& e) {
    fault_ = e.what();
  } catch (const WriteError& e) {
    write_error_ = e.what();
  }
}

void TrainRun::Begin() {
  if (from_ == nullptr) {
    master_.Start();
  } else {
    summary_.SetMemory(from_->summary);
    master_.Resume(*from_);
  }
}

void TrainRun::Loop(const RunHooks& hooks) {
  while (!master_.Done() && !hooks.ends()) {
    if (hooks.admits()) {
      const bool timed = hooks.exchanged != nullptr;
      const Clock::time_point begin = timed ? Clock::now() : Clock::time_point();
      Exchange(hooks, false);
      if (timed) hooks.exchanged(std::chrono::duration<double>(Clock::now() - begin).count());
    }
    hooks.turned();
  }
}

bool TrainRun::Exchange(const RunHooks& hooks, bool wanted) {
  hooks.begins();
  const bool leaves_checkpoint =
      output_ != nullptr && master_.GivesCheckpoints() && output_->AskForCheckpoint(master_, wanted);
  master_.Exchange();
  if (leaves_checkpoint) Write([&] { output_->KeepCheckpoint(master_, summary_); });
  return leaves_checkpoint;
}

void TrainRun::LeaveCheckpoint(const RunHooks& hooks, std::chrono::duration<double> patience) {
  const Clock::time_point begin = Clock::now();
  while (!master_.Done() && Clock::now() - begin < patience) {
    const bool at_record = master_.RecordIsNext();
    Exchange(hooks, true);
    if (at_record) return;  // with a checkpoint, unless none are kept
  }
}

std::string TrainRun::Finish(double wall_s, const std::string& fault) {
  const std::string json = train_results::SummaryJson(summary_, master_, wall_s, fault.empty() ? fault_ : fault);
  if (output_ == nullptr) return json;
  try {
    output_->Finish(master_, summary_, json);
  } catch (const std::exception& e) {
    if (write_error_.empty()) write_error_ = e.what();
  }
  return json;
}

std::vector<std::string> TrainRun::Warnings() const {
  std::vector<std::string> warnings;
  if (master_.Done()) warnings = master_.schedule().NotGiven();
  if (!summary_.RouteWarning().empty()) warnings.push_back(summary_.RouteWarning());
  return warnings;
}

ExitCode TrainRun::exit_code() const {
  if (!write_error_.empty()) return kFailure;
  if (!fault_.empty()) return kSimulationFault;
  return master_.Done() ? kSuccess : kInterrupted;
}

}  // namespace train_run
