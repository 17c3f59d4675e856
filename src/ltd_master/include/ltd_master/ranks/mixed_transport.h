#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "train_dynamics/train/lockstep.h"

namespace ltd_master {

/// A train with external vehicles: one transport has the vehicles of this program, the other one the external ones.
/// They are called one after the other.
class MixedTransport : public train_dynamics::Transport {
 public:
  MixedTransport(std::unique_ptr<train_dynamics::Transport> built_in,
                 std::unique_ptr<train_dynamics::Transport> external)
      : built_in_(std::move(built_in)), external_(std::move(external)) {}

  void Start(train_dynamics::ExchangeReply& reply) override {
    built_in_->Start(reply);
    external_->Start(reply);
  }
  void Resume(std::uint64_t exchange, const std::vector<train_dynamics::StateRow>& snapshot,
              train_dynamics::ExchangeReply& reply) override {
    built_in_->Resume(exchange, snapshot, reply);
    external_->Resume(exchange, snapshot, reply);
  }
  bool GivesSnapshots() const override { return built_in_->GivesSnapshots() && external_->GivesSnapshots(); }
  void Exchange(const train_dynamics::ExchangeRequest& request, train_dynamics::ExchangeReply& reply) override {
    built_in_->Exchange(request, reply);
    if (reply.fault.vehicle < 0) external_->Exchange(request, reply);
  }

 private:
  std::unique_ptr<train_dynamics::Transport> built_in_, external_;
};

}  // namespace ltd_master
