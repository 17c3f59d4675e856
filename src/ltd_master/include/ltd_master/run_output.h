#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "ltd_master/bag_recorder.h"
#include "ltd_master/csv_recorder.h"
#include "ltd_master/recorder_thread.h"

namespace ltd_master {

struct OutputOptions {
  std::string folder;  ///< empty: nothing is written
  bool record_bag = true;
  bool csv = false;
};

/// The folder of a run's results.
///
///   config.yaml   the scenario with everything resolved, at once; runs again to the same bits
///   train.bag     the records as they come (and tables, if wanted)
///   summary.json  at the end; its absence tells that the run was cut off
class RunOutput {
 public:
  /// Makes the folder, clears it of the results of an earlier run and writes config.yaml.
  /// @throws std::exception if that cannot be done, or if an input of the run lies in this very folder
  RunOutput(const OutputOptions& options, const std::string& scenario_file,
            const train_dynamics::ScenarioParams& scenario);

  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// An observer of the run's TrainMaster; the files are written by another thread.
  /// @throws std::exception if an earlier record could not be written
  void Record(const train_dynamics::TrainRecord& record);

  /// Completes all files that can be. @throws std::exception if one could not be written
  void Finish(const train_dynamics::TrainMaster& master, const std::string& summary_json);

 private:
  std::filesystem::path folder_;
  std::unique_ptr<BagRecorder> bag_;
  std::unique_ptr<CsvRecorder> csv_;
  std::unique_ptr<RecorderThread> thread_;  ///< ends before its recorders do
};

/// Writes a whole file or nothing. @throws std::runtime_error
void WriteFile(const std::filesystem::path& file, const std::string& text);

}  // namespace ltd_master
