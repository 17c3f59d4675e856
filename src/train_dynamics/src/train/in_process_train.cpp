#include "train_dynamics/train/in_process_train.h"

#include <algorithm>

#include "train_dynamics/train/thread_team.h"

namespace train_dynamics {

InProcessTransport::InProcessTransport(const ScenarioParams& scenario, const Consist& consist, int threads) {
  const int n = consist.vehicles();
  const int size = std::clamp(threads, 1, n);
  for (int i = 0; i < size; ++i) {
    const int first = n * i / size, next = n * (i + 1) / size;
    shares_.push_back({first, MakeVehicleBlock(scenario, consist, first, next - first)});
  }
  team_ = std::make_unique<ThreadTeam>(size);
}

InProcessTransport::~InProcessTransport() = default;

void InProcessTransport::Start(ExchangeReply& reply) {
  for (const Share& share : shares_) share.block->Report(share.first, true, reply);
}

void InProcessTransport::Exchange(const ExchangeRequest& request, ExchangeReply& reply) {
  team_->Run([&](int member) {
    Share& share = shares_[member];
    share.sound = share.block->Advance(request, share.first, reply);
  });
  for (const Share& share : shares_) {
    if (share.sound) continue;
    reply.fault = share.block->FindFault();
    return;
  }
}

}  // namespace train_dynamics
