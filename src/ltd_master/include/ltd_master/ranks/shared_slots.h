#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>
#include <train_brake_msgs/exchange_memory.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "train_dynamics/train/faster_way.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/thread_team.h"

namespace ltd_master {

/// The master's end of train_brake_msgs/exchange_memory.h: calls of Step to ranks on the same machine.
///
/// Ranks that share cores sleep between two calls, or first yield some times, whichever is faster under the present
/// load (train/faster_way.h).
///
/// Only the rank itself can find out whether it is on the same machine: it is offered a slot when it is configured, and
/// accepts or declines it.
class SharedSlots {
 public:
  /// Makes slots for all ranks, and spare ones for processes that replace lost ranks.
  /// @throws std::exception if the system has no such memory
  SharedSlots(const std::vector<train_dynamics::Rank>& ranks, std::uint64_t run_id);
  ~SharedSlots();
  SharedSlots(const SharedSlots&) = delete;
  SharedSlots& operator=(const SharedSlots&) = delete;

  /// Puts an offer into a request: the rank's slot, a new one for a new process; none if no slot is left.
  void Offer(int rank, train_brake_msgs::ConfigureRequest& request);
  /// Takes the rank's answer to the offer.
  void Settle(int rank, const train_brake_msgs::ConfigureResponse& response);
  /// The rank's process is given up, and its slot with it.
  void Drop(int rank);
  bool Has(int rank) const { return ranks_[rank].is_used; }

  /// Begins a call: writes the requests of all ranks that have slots, and wakes those ranks.
  void Send(const std::vector<train_brake_msgs::Step>& calls);
  /// Waits for replies, at most for that time; it may return early. Read() shows which have arrived.
  void Wait(double timeout_s);
  enum class Reply { kNone, kRead, kTooLarge };
  /// @throws std::exception if the reply cannot be read
  Reply Read(int rank, train_brake_msgs::StepResponse& response) const;
  /// The rank that replied last; -1: unknown.
  int last_rank() const;

 private:
  static constexpr std::uint32_t kNoSlot = ~0u;
  struct RankSlot {
    std::uint32_t slot = kNoSlot;
    bool is_used = false;
    std::uint32_t threads = 0;  ///< of the rank
  };

  std::uint32_t NewSlot();

  int descriptor_ = -1;
  std::unique_ptr<train_brake_msgs::ExchangeMemory> memory_;
  std::vector<RankSlot> ranks_;
  std::uint32_t next_slot_ = 0;  ///< never given to a rank
  std::uint64_t call_ = 0;       ///< number of the present one
  const unsigned cores_ = static_cast<unsigned>(train_dynamics::UsableCores());
  train_brake_msgs::AdaptiveSpin spin_;
  std::uint32_t seen_ = 0;  ///< events of `replies`
  train_dynamics::FasterWay faster_;
  std::chrono::steady_clock::time_point begin_, end_;  ///< of the last call
};

}  // namespace ltd_master
