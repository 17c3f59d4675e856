#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/train/byte_stream.h"

namespace train_dynamics {

/// The state of one vehicle as numbers: the vehicle alone defines how many and which.
using StateRow = std::vector<double>;

/// The state of a contiguous block of vehicles at the beginning of an exchange: all that their further motion depends
/// on, except their parameters.
struct BlockSnapshot {
  std::uint64_t exchange = 0;    ///< the next one
  std::uint64_t first = 0;       ///< index of the block's first vehicle in the train
  std::vector<StateRow> states;  ///< [vehicle of the block], see VehicleBlock::Save
};

/// The train at time 0 of its run, to which its later records are compared.
struct TimeZero {
  double mean_position_m = 0.0;  ///< of the vehicles' masses, along the track
  double stored_energy_j = 0.0;  ///< kinetic and potential, see EnergyLedger::Stored
};

/// The state of a whole train and of its books at the beginning of an exchange. Vehicles are not tied to the
/// ranks that they were in.
struct TrainCheckpoint {
  std::string scenario;            ///< its text, verbatim; its first line is "# PROGRAM VERSION"
  std::uint64_t exchange = 0;      ///< the next one; follows a record
  std::uint64_t state_digest = 0;  ///< chained over all records so far
  TimeZero at_time_zero;
  std::vector<StateRow> vehicles;       ///< [vehicle], see VehicleBlock::Save
  std::vector<double> connections;      ///< InTrainForces::Memory
  std::vector<double> brake;            ///< BrakeSystem::ForEachField
  std::vector<double> locomotives;      ///< Locomotives::ForEachField
  std::vector<double> breakaway;        ///< BreakawayLoads::ForEachField
  std::vector<double> driver;           ///< CommandSchedule::Memory
  std::vector<double> built_in_driver;  ///< BuiltInDriverState::ForEachField; empty without one
  std::vector<double> summary;          ///< RunSummary::Memory
  Bytes output;                         ///< what the run's recorders need to continue
};

/// @throws SnapshotError unless there is one row per vehicle
void CheckRows(const std::vector<StateRow>& rows, int vehicles);

/// As bytes: a mark, the format's version, the contents (little-endian, counts before arrays), a checksum.
Bytes Encode(const BlockSnapshot& snapshot);
Bytes Encode(const TrainCheckpoint& checkpoint);

/// @throws SnapshotError if the bytes are something else, of another version, cut short or damaged. Of a checkpoint of
/// another format version it names the program that wrote it.
BlockSnapshot DecodeBlockSnapshot(const Bytes& bytes);
TrainCheckpoint DecodeTrainCheckpoint(const Bytes& bytes);

/// Collects the numbers of a list of fields, which serves for saving and for restoring.
class MemoryWriter {
 public:
  void operator()(double value) { numbers_.push_back(value); }
  std::vector<double> Take() { return std::move(numbers_); }

 private:
  std::vector<double> numbers_;
};

/// Gives them back in the same order. Keeps a reference.
class MemoryReader {
 public:
  explicit MemoryReader(const std::vector<double>& numbers) : numbers_(numbers) {}
  /// @throws SnapshotError if there are no more
  void operator()(double& value) {
    if (at_ == numbers_.size()) throw SnapshotError("has too few numbers");
    value = numbers_[at_++];
  }
  /// @throws SnapshotError if there are more
  void End() const {
    if (at_ != numbers_.size()) throw SnapshotError("has too many numbers");
  }

 private:
  const std::vector<double>& numbers_;
  std::size_t at_ = 0;
};

/// Adds them to a digest. Keeps a reference.
class MemoryDigest {
 public:
  explicit MemoryDigest(Digest& digest) : digest_(digest) {}
  void operator()(double value) { digest_.Add(value); }

 private:
  Digest& digest_;
};

}  // namespace train_dynamics
