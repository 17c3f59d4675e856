#pragma once

#include "train_dynamics/train/threaded_block.h"

namespace train_dynamics {

/// All vehicles in this process, except external ones, distributed over a fixed number of threads; any number gives the
/// same bits.
class InProcessTransport : public Transport {
 public:
  /// @param threads  1 = the caller's only; at most one per vehicle is used
  /// @param is_joined  another transport has the external vehicles
  /// @throws std::invalid_argument if there are external vehicles and no transport for them
  InProcessTransport(const ScenarioParams& scenario, const Consist& consist, int threads, bool is_joined = false)
      : count_(consist.vehicles()),
        interval_s_(scenario.exchange_interval_s),
        vehicles_(scenario, consist, 0, count_, threads) {
    if (!is_joined) RefuseExternal(scenario);
  }

  /// @throws std::invalid_argument if a scenario has external vehicles
  static void RefuseExternal(const ScenarioParams& scenario);

  void Start(ExchangeReply& reply) override;
  void Resume(std::uint64_t exchange, const std::vector<StateRow>& snapshot, ExchangeReply& reply) override;
  void Exchange(const ExchangeRequest& request, ExchangeReply& reply) override;

 private:
  int count_;
  double interval_s_;
  ThreadedBlock vehicles_;
};

}  // namespace train_dynamics
