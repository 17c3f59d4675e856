#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/train/run_summary.h"
#include "train_results/bag_recorder.h"
#include "train_results/csv_recorder.h"
#include "train_results/folder_lock.h"
#include "train_results/plain_file.h"
#include "train_results/recorder_thread.h"
#include "train_results/resume.h"

namespace train_results {

/// What happens when results cannot be written.
enum class OnWriteError {
  kStop,  ///< the run ends
  kGoOn   ///< the run continues to its end without records, and ends with an error
};

struct OutputOptions {
  std::string folder;  ///< empty: nothing is written
  bool record_bag = true;
  bool csv = false;
  double checkpoint_interval_s = 10.0;  ///< of simulated time; 0: none
  OnWriteError on_write_error = OnWriteError::kStop;
  /// Called at once with each failure in spite of which the run continues.
  std::function<void(const std::string&)> complain = [](const std::string&) {};
};

/// The folder of a run's results.
///
///   config.yaml   the resolved scenario, at the start; runs again to the same bits
///   train.bag     the records as they come (and tables, if wanted)
///   branched_from where a branch left another run (a checkpoint, for verify)
///   checkpoint    now and then, and at the end: where the run can be resumed
///   couplers.csv  at the end: the largest forces of every connection, of all exchanges
///   slides.csv, track_wear.csv  at the end: see slide_tables.h
///   replay.yaml   at the end of a run with live commands: the scenario with them, runs again to the same bits
///   summary.json  at the end; without it the run was cut off
class RunOutput {
 public:
  /// Makes the folder, clears it of the results of an earlier run and writes config.yaml.
  /// @param inputs  the files of which the scenario was made
  /// @throws std::exception if that fails, if one of the inputs is in this folder, or if another run writes into it
  RunOutput(const OutputOptions& options, const std::vector<std::filesystem::path>& inputs,
            const train_dynamics::ScenarioParams& scenario);

  /// Continues the results of a run; a branch copies them to a folder of its own first.
  /// @param options  folder: empty for that of the run; a branch needs another one
  RunOutput(const OutputOptions& options, const ResumedRun& run);

  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// An observer of the run's TrainMaster; the files are written by another thread.
  /// @throws std::exception if an earlier record could not be written, unless the run shall continue
  void Record(const train_dynamics::TrainRecord& record);

  /// Requests a checkpoint if one is due at the end of the next exchange, or is `wanted` and possible there. @return
  /// whether it was requested; then call KeepCheckpoint after the exchange
  bool AskForCheckpoint(train_dynamics::TrainMaster& master, bool wanted = false) const;
  /// Replaces the folder's checkpoint atomically while the run continues, once the records before it are on the disk.
  /// @throws as Record
  void KeepCheckpoint(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary);

  /// Completes all files, as far as possible. @throws std::exception if one could not be written
  void Finish(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary,
              const std::string& summary_json);

 private:
  void StartThread();
  bool HasRecorder() const { return bag_ != nullptr || csv_ != nullptr; }
  /// In the recorder's thread: adds the recorders' state to a checkpoint, and has it written.
  void LeaveCheckpoint(train_dynamics::TrainCheckpoint checkpoint);
  /// Executes an action that writes; if it fails, proceeds as on_write_error sets.
  template <class Action>
  void Attempt(const Action& action);

  OutputOptions options_;
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  train_dynamics::ScenarioParams scenario_;
  std::string identity_;       ///< of the scenario, see IdentityOf
  long checkpoint_exchanges_;  ///< from one to the next; 0: none
  std::exception_ptr error_;   ///< the first one, if the run continues
  std::unique_ptr<BagRecorder> bag_;
  std::unique_ptr<CsvRecorder> csv_;
  std::future<void> to_disk_;               ///< writes the last checkpoint; only the next one and the end wait for it
  std::unique_ptr<RecorderThread> thread_;  ///< ends before what it uses does
};

}  // namespace train_results
