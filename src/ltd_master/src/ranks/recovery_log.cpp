#include "ltd_master/ranks/recovery_log.h"

#include <algorithm>
#include <utility>

namespace ltd_master {
namespace {

template <class Loads, class Function>
void ForEachArray(Loads& loads, const Function& function) {
  function(loads.coupler_force_n);
  train_dynamics::ForEachLoad([&](const train_dynamics::LoadInfo&, auto& array) { function(array); }, loads);
}

}  // namespace

void RecoveryLog::Begin(std::uint64_t exchange, std::vector<Snapshot> snapshots) {
  exchange_ = exchange;
  snapshots_ = std::move(snapshots);
  size_ = 0;
  inputs_.clear();
  patches_.clear();
}

void RecoveryLog::Add(const train_dynamics::ExchangeRequest& request) {
  ForEachArray(request,
               [this](const std::vector<double>& array) { inputs_.insert(inputs_.end(), array.begin(), array.end()); });
  patches_.push_back(request.friction_patches.size());
  ++size_;
}

void RecoveryLog::Get(std::uint64_t i, train_dynamics::ExchangeRequest& request) const {
  request.exchange = exchange_ + i;
  request.record = request.ledger = request.snapshot = false;
  request.friction_patches.resize(patches_[i]);
  auto from = inputs_.begin() + static_cast<long>(i * (inputs_.size() / size_));
  ForEachArray(request, [&from](std::vector<double>& array) {
    std::copy_n(from, array.size(), array.begin());
    from += static_cast<long>(array.size());
  });
}

}  // namespace ltd_master
