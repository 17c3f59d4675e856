#pragma once

#include <cstdint>
#include <vector>

#include "train_dynamics/train/lockstep.h"

namespace ltd_master {

/// The data to restore a lost rank: its vehicles' last snapshot, and the loads on the train since.
class RecoveryLog {
 public:
  using Snapshot = std::vector<std::uint8_t>;  ///< empty: time 0

  /// Restarts the log at an exchange. @param snapshots  [rank]
  void Begin(std::uint64_t exchange, std::vector<Snapshot> snapshots);

  /// Keeps the inputs of the next exchange.
  void Add(const train_dynamics::ExchangeRequest& request);

  std::uint64_t exchange() const { return exchange_; }  ///< of the snapshots
  const Snapshot& snapshot(int rank) const { return snapshots_[rank]; }
  std::uint64_t size() const { return size_; }  ///< exchanges since
  /// The inputs of exchange() + i, into a request whose arrays have their sizes, the same for all exchanges; no record
  /// is asked for. The request keeps the friction patches that it had at that exchange.
  void Get(std::uint64_t i, train_dynamics::ExchangeRequest& request) const;

 private:
  std::uint64_t exchange_ = 0;
  std::vector<Snapshot> snapshots_;
  std::uint64_t size_ = 0;
  std::vector<std::size_t> patches_;  ///< [exchange] how many of the friction patches it had
  std::vector<double> inputs_;        ///< [exchange][array of LoadArrays][number]
};

}  // namespace ltd_master
