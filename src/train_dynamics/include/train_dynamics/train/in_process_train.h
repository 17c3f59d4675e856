#pragma once

#include "train_dynamics/train/threaded_block.h"

namespace train_dynamics {

/// All vehicles in this process, shared out over a fixed number of threads; any number gives the same bits.
class InProcessTransport : public Transport {
 public:
  /// @param threads  1 = the caller's only; more than vehicles is as many as vehicles
  InProcessTransport(const ScenarioParams& scenario, const Consist& consist, int threads)
      : vehicles_(scenario, consist, 0, consist.vehicles(), threads) {}

  void Start(ExchangeReply& reply) override;
  void Exchange(const ExchangeRequest& request, ExchangeReply& reply) override;

 private:
  ThreadedBlock vehicles_;
};

}  // namespace train_dynamics
