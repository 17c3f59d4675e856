#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/train/driver_command.h"
#include "train_results/bag_file.h"

namespace train_results {

/// The messages of one topic of a run, in the order of their exchanges.
class RecordedTopic {
 public:
  /// Keeps references. @throws UnreadableBag
  RecordedTopic(BagFile& bag, const BagFile::Topic& topic);

  const std::string& name() const { return topic_.name; }
  bool done() const { return next_ == topic_.messages.size(); }
  /// The exchange of the next message; there must be one.
  std::uint64_t exchange() const { return exchange_; }
  const Bytes& message() const { return message_; }
  /// @throws UnreadableBag
  void Advance();

 private:
  void Load();

  BagFile& bag_;
  const BagFile::Topic& topic_;
  std::size_t next_ = 0;
  std::uint64_t exchange_ = 0;
  Bytes message_;
};

/// The program that wrote the scenario in a bag, "train_brake 0.2.0"; empty if the bag does not have it. Does not read
/// other messages, whose definitions another version may have changed.
/// @throws UnreadableBag
std::string WriterOf(const std::string& file);

/// The run of one train in a bag, recorded by train_sim, ltd_master or rosbag record.
///
/// Topics are known by their types and share the namespace of the topic of TrainState.
class RecordedRun {
 public:
  /// @param train  namespace, "/train"; empty: that of the only train in the bag
  /// @throws UnreadableBag
  RecordedRun(const std::string& file, const std::string& train);

  /// The whole scenario as YAML, if the bag has it.
  std::optional<std::string> Scenario();

  /// The commands that were given live, each bound to its exchange.
  /// @throws UnreadableBag if one of them is damaged
  std::vector<train_dynamics::DriverCommand> LiveCommands();

  RecordedTopic& state() { return *state_; }
  /// These are null where the bag has none.
  RecordedTopic* forces() { return forces_.get(); }
  RecordedTopic* pressures() { return pressures_.get(); }
  RecordedTopic* ledger() { return ledger_.get(); }
  RecordedTopic* slides() { return slides_.get(); }
  /// @param name  "wagon_100"
  RecordedTopic* wagon(const std::string& name);

 private:
  BagFile bag_;
  std::string train_;
  std::unique_ptr<RecordedTopic> state_, forces_, pressures_, ledger_, slides_;
  std::map<std::string, std::unique_ptr<RecordedTopic>> wagons_;  ///< by name
};

}  // namespace train_results
