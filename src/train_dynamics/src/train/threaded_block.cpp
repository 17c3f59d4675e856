#include "train_dynamics/train/threaded_block.h"

#include <algorithm>
#include <functional>

#include "train_dynamics/train/thread_team.h"
#include "train_dynamics/vehicle/lane_kernels.h"

namespace train_dynamics {

namespace {

/// Cost of a step of a vehicle, in steps of an LTD vehicle.
constexpr long kCostOfBarrier = 1000;
long CostOf(VehicleModel model) { return model == VehicleModel::kTwoD ? kCostOfBarrier / kMostLanes : 1; }

/// The cost of the vehicles [first, first + i), for i = 0 ... count.
std::vector<long> CostsBefore(const ScenarioParams& scenario, int first, int count) {
  const std::vector<VehicleModel> models = scenario.VehicleModels();
  std::vector<long> before = {0};
  for (int i = first; i < first + count; ++i) before.push_back(before.back() + CostOf(models[i]));
  return before;
}

}  // namespace

int UsefulThreads(const ScenarioParams& scenario, int first, int count, int threads) {
  const long worth = CostsBefore(scenario, first, count).back() / kCostOfBarrier;
  return static_cast<int>(std::clamp(worth, 1L, std::max(1L, long{threads})));
}

ThreadedBlock::ThreadedBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count,
                             int threads) {
  const int size = std::clamp(threads, 1, count);
  const std::vector<long> before = CostsBefore(scenario, first, count);
  for (int i = 0, begin = 0; i < size; ++i) {
    // The last vehicle that an equal part of the work reaches; at least one vehicle for each share.
    const auto beyond = std::upper_bound(before.begin(), before.end(), before.back() * (i + 1) / size);
    const int end = std::clamp(static_cast<int>(beyond - before.begin()) - 1, begin + 1, count - (size - 1 - i));
    shares_.push_back({begin, MakeVehicleBlock(scenario, consist, first + begin, end - begin)});
    begin = end;
  }
  team_ = std::make_unique<ThreadTeam>(size);
}

ThreadedBlock::~ThreadedBlock() = default;

bool ThreadedBlock::Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) {
  if (shares_.size() == 1) return shares_[0].block->Advance(request, offset, reply);  // first of the first is 0
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

void ThreadedBlock::TellSlides(bool ongoing, double time_s, std::vector<SlideEvent>& slides) {
  for (const Share& share : shares_) share.block->TellSlides(ongoing, time_s, slides);
}

void ThreadedBlock::Save(StateRow* rows) const {
  for (const Share& share : shares_) share.block->Save(rows + share.first);
}

void ThreadedBlock::Restore(const StateRow* rows) {
  for (Share& share : shares_) share.block->Restore(rows + share.first);
}

VehicleFault ThreadedBlock::FindFault() const {
  for (const Share& share : shares_) {
    VehicleFault fault = share.block->FindFault();
    if (fault.vehicle >= 0) return fault;
  }
  return {};
}

}  // namespace train_dynamics
