#pragma once

#include <memory>
#include <vector>

#include "train_dynamics/train/vehicle_block.h"

namespace train_dynamics {

class ThreadTeam;

/// All vehicles in this process, shared out over a fixed number of threads in contiguous blocks.
///
/// The same bits for any number of threads: a vehicle's step depends on nothing but its own state and loads.
class InProcessTransport : public Transport {
 public:
  /// @param threads  1 = the caller's only; more than vehicles is as many as vehicles
  InProcessTransport(const ScenarioParams& scenario, const Consist& consist, int threads);
  ~InProcessTransport() override;

  void Start(ExchangeReply& reply) override;
  void Exchange(const ExchangeRequest& request, ExchangeReply& reply) override;

 private:
  struct Share {
    int first;
    std::unique_ptr<VehicleBlock> block;
    bool sound = true;
  };
  std::vector<Share> shares_;  ///< [thread]
  std::unique_ptr<ThreadTeam> team_;
};

}  // namespace train_dynamics
