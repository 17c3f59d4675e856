#include "train_dynamics/train/threaded_block.h"

#include <algorithm>
#include <functional>

#include "train_dynamics/train/thread_team.h"
#include "train_dynamics/vehicle/lane_kernels.h"

namespace train_dynamics {

int UsefulThreads(VehicleModel model, int vehicles, int threads) {
  const int per_thread = model == VehicleModel::kTwoD ? kMostLanes : 1000;
  return std::clamp(vehicles / per_thread, 1, std::max(1, threads));
}

ThreadedBlock::ThreadedBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count,
                             int threads) {
  const int size = std::clamp(threads, 1, count);
  for (int i = 0; i < size; ++i) {
    const int begin = static_cast<int>(long{count} * i / size);
    const int end = static_cast<int>(long{count} * (i + 1) / size);
    shares_.push_back({begin, MakeVehicleBlock(scenario, consist, first + begin, end - begin)});
  }
  team_ = std::make_unique<ThreadTeam>(size);
}

ThreadedBlock::~ThreadedBlock() = default;

bool ThreadedBlock::Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) {
  const auto advance = [&](int member) {
    Share& share = shares_[member];
    share.sound = share.block->Advance(request, offset + share.first, reply);
  };
  team_->Run(std::ref(advance));  // by reference: a copy would be allocated
  return std::all_of(shares_.begin(), shares_.end(), [](const Share& share) { return share.sound; });
}

void ThreadedBlock::Report(int offset, bool with_energy, ExchangeReply& reply) const {
  for (const Share& share : shares_) share.block->Report(offset + share.first, with_energy, reply);
}

void ThreadedBlock::Save(double* state) const {
  for (const Share& share : shares_) share.block->Save(state + share.first * NumbersPerVehicle());
}

void ThreadedBlock::Restore(const double* state) {
  for (Share& share : shares_) share.block->Restore(state + share.first * NumbersPerVehicle());
}

VehicleFault ThreadedBlock::FindFault() const {
  for (const Share& share : shares_) {
    VehicleFault fault = share.block->FindFault();
    if (fault.vehicle >= 0) return fault;
  }
  return {};
}

}  // namespace train_dynamics
