#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>
#include <train_brake_msgs/exchange_memory.h>

#include <cstdint>

#include "train_dynamics/train/thread_team.h"

namespace wagon_node {

/// A rank's end of train_brake_msgs/exchange_memory.h: calls of Step from a master on the same machine.
class SharedSlot {
 public:
  /// Takes the offer of a request.
  /// @throws std::exception if there is no offer, or this process cannot use it
  explicit SharedSlot(const train_brake_msgs::ConfigureRequest& offer);

  /// Waits for a call. @return whether there is one
  bool Wait(double timeout_s);
  /// Ends a wait in another thread.
  void Wake() { memory_.head().requests.Notify(); }

  /// @throws std::exception if the request cannot be read
  void Read(train_brake_msgs::StepRequest& request);
  void Reply(const train_brake_msgs::StepResponse& response);

 private:
  train_brake_msgs::ExchangeMemory memory_;
  const std::uint32_t slot_;
  const unsigned cores_ = static_cast<unsigned>(train_dynamics::UsableCores());
  train_brake_msgs::AdaptiveSpin spin_;
  std::uint64_t served_;  ///< number of the last call that was read
};

}  // namespace wagon_node
