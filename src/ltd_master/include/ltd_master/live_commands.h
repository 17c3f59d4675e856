#pragma once

#include <train_brake_msgs/DriverCommand.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "train_dynamics/train/scenario.h"

namespace ltd_master {

/// Commands of a driver in another node: received at any time, by any thread, and given to the train at the start of an
/// exchange, in the order of their arrival.
class LiveCommands {
 public:
  /// Keeps a reference.
  explicit LiveCommands(const train_dynamics::ScenarioParams& scenario) : scenario_(scenario) {}

  /// A command for the start of an exchange.
  /// @throws std::invalid_argument for an unknown kind, a number out of range, or an unknown locomotive; names it
  train_dynamics::DriverCommand Judge(const train_brake_msgs::DriverCommand& message, std::uint64_t exchange) const;

  /// @return the earliest exchange at the start of which it can be given
  /// @throws std::invalid_argument as Judge, and if there are too many patches of rail
  std::uint64_t Receive(const train_brake_msgs::DriverCommand& message);

  /// For the run: the commands that are due before this exchange, which begins now.
  /// @param patches  TrainMaster::patches(), without those returned here
  std::vector<train_dynamics::DriverCommand> Take(std::uint64_t exchange, std::size_t patches);

  /// Of all commands taken so far: the largest number of exchanges between receipt and effect, and their count.
  std::uint64_t largest_latency() const;
  std::uint64_t count() const;

 private:
  struct Received {
    train_dynamics::DriverCommand command;
    std::uint64_t exchange;  ///< that was the next when it came
  };

  const train_dynamics::ScenarioParams& scenario_;
  mutable std::mutex mutex_;
  std::vector<Received> received_;
  std::size_t patches_ = 0;  ///< of rail, received ones included
  std::uint64_t next_exchange_ = 0, largest_latency_ = 0, count_ = 0;
};

}  // namespace ltd_master
