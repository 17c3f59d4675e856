#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "train_dynamics/numeric/stream_digest.h"
#include "train_dynamics/train/train_master.h"

namespace train_results {

/// Writes a run as CSV tables into a folder, with units in the headers.
///
///   train_history.csv  mean, lead and tail speed, largest forces, mean pressure
///   pressures.csv      cylinder pressure of every vehicle; serves as a scenario's pressure_table
///   pipe_pressure_pa.csv  auxiliary_reservoir_pa.csv  emergency_reservoir_pa.csv  valve_mode.csv
///                      of every vehicle, where the brake has them (brake/pneumatic/brake_record.h)
///   wagon_NNN.csv      one per detailed vehicle
///   vehicles.csv       the last record of every vehicle (at the end)
class CsvRecorder {
 public:
  explicit CsvRecorder(const std::filesystem::path& folder);
  /// Prepares to continue the tables of a checkpoint. Only reads them; GoOn changes them.
  /// @throws std::invalid_argument, SnapshotError if their bytes have changed since
  CsvRecorder(const std::filesystem::path& folder, const train_dynamics::Bytes& checkpoint, int vehicles);
  /// Opens those tables and truncates them to the checkpoint; nothing can be written before this call.
  /// @throws std::filesystem::filesystem_error
  void GoOn();
  train_dynamics::Bytes Checkpoint();

  /// An observer of the run's TrainMaster. @throws std::runtime_error if a table could not be written
  void Record(const train_dynamics::TrainRecord& record);

  /// Writes the tables that are made at the end. @throws std::runtime_error if one could not be written
  void Close();

 private:
  void OpenWagon(int vehicle);
  void CheckAll() const;

  std::filesystem::path folder_;
  int vehicles_ = 0;  ///< of the train, known from the first record or a checkpoint
  std::ofstream history_, pressures_;
  std::map<std::string, std::ofstream> brake_;  ///< by the name of the table
  std::map<int, std::ofstream> wagons_;
  std::map<std::string, train_dynamics::StreamDigest> digests_;  ///< of each table at the last checkpoint
  train_dynamics::RecordArrays last_;                            ///< the last record of the vehicles
};

/// Writes couplers.csv into a folder: the largest tension and compression [N] of every connection, each with its time
/// [s], of all exchanges up to now. Replaces the file, at once or not at all.
/// @throws std::runtime_error if it could not be written
void WriteCouplerTable(const std::filesystem::path& folder, const train_dynamics::TrainMaster& master);

}  // namespace train_results
