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
  kGoOn   ///< the run goes on to its end without records, and ends with an error
};

struct OutputOptions {
  std::string folder;  ///< empty: nothing is written
  bool record_bag = true;
  bool csv = false;
  double checkpoint_interval_s = 10.0;  ///< of simulated time; 0: none
  OnWriteError on_write_error = OnWriteError::kStop;
  /// Told at once of what the run goes on in spite of.
  std::function<void(const std::string&)> complain = [](const std::string&) {};  ///< at once, where the run goes on
};

/// The folder of a run's results.
///
///   config.yaml   the scenario with everything resolved, at once; runs again to the same bits
///   train.bag     the records as they come (and tables, if wanted)
///   branched_from where a branch left another run (a checkpoint, for verify)
///   checkpoint    now and then, and at the end: where the run can be resumed
///   couplers.csv  at the end: the largest forces of every connection, of all exchanges
///   slides.csv, track_wear.csv  at the end: see slide_tables.h
///   replay.yaml   at the end of a run with live commands: the scenario with them, runs again to the same bits
///   summary.json  at the end; its absence tells that the run was cut off
class RunOutput {
 public:
  /// Makes the folder, clears it of the results of an earlier run and writes config.yaml.
  /// @param inputs  the files of which the scenario was made
  /// @throws std::exception if that cannot be done, if one of the inputs lies in this very folder, or if another
  ///         run is writing into it
  RunOutput(const OutputOptions& options, const std::vector<std::filesystem::path>& inputs,
            const train_dynamics::ScenarioParams& scenario);

  /// Goes on with the results of a run, or copies them, in a branch, to a folder of its own.
  /// @param options  folder: empty for that of the run; must be another for a branch
  RunOutput(const OutputOptions& options, const ResumedRun& run);

  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// An observer of the run's TrainMaster; the files are written by another thread.
  /// @throws std::exception if an earlier record could not be written, unless the run is to go on
  void Record(const train_dynamics::TrainRecord& record);

  /// Asks for a checkpoint where one is due at the end of the next exchange, or is `wanted` and possible there.
  /// @return whether it does; then KeepCheckpoint comes after the exchange
  bool AskForCheckpoint(train_dynamics::TrainMaster& master, bool wanted = false) const;
  /// Replaces the folder's checkpoint, as a whole or not at all, while the run goes on: once the records before it are
  /// on the disk. @throws as Record
  void KeepCheckpoint(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary);

  /// Completes all files that can be. @throws std::exception if one could not be written
  void Finish(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary,
              const std::string& summary_json);

 private:
  void StartThread();
  bool HasRecorder() const { return bag_ != nullptr || csv_ != nullptr; }
  /// Of the recorder's thread: completes a checkpoint with what the recorders need, and has it written.
  void LeaveCheckpoint(train_dynamics::TrainCheckpoint checkpoint);
  /// Does something that writes; if that fails, acts as on_write_error tells.
  template <class Action>
  void Attempt(const Action& action);

  OutputOptions options_;
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  train_dynamics::ScenarioParams scenario_;
  std::string identity_;       ///< of the scenario, see IdentityOf
  long checkpoint_exchanges_;  ///< from one to the next; 0: none
  std::exception_ptr error_;   ///< the first, where the run goes on
  std::unique_ptr<BagRecorder> bag_;
  std::unique_ptr<CsvRecorder> csv_;
  std::future<void> to_disk_;               ///< of the last checkpoint; only the next one and the end wait for a disk
  std::unique_ptr<RecorderThread> thread_;  ///< ends before what it uses does
};

}  // namespace train_results
