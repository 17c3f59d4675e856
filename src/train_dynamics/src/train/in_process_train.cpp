#include "train_dynamics/train/in_process_train.h"

#include <stdexcept>

#include "train_dynamics/train/ranks.h"

namespace train_dynamics {

void InProcessTransport::RefuseExternal(const ScenarioParams& scenario) {
  const std::vector<Rank> external = ExternalRanks(scenario.train);
  if (external.empty()) return;
  const bool is_one = external.size() == 1 && external.front().count == 1;
  throw std::invalid_argument(VehiclesText(external.front()) + (external.size() > 1 ? " and others" : "") +
                              (is_one ? " is" : " are") + " external, moved by the node " + external.front().name +
                              ": run such a train as a ROS graph (rosrun train_brake run), with its node");
}

void InProcessTransport::Start(ExchangeReply& reply) { vehicles_.Report(0, true, reply); }

void InProcessTransport::Resume(std::uint64_t /*exchange*/, const std::vector<StateRow>& snapshot,
                                ExchangeReply& reply) {
  CheckRows(snapshot, count_);
  vehicles_.Restore(snapshot.data());
  vehicles_.Report(0, true, reply);
}

void InProcessTransport::Exchange(const ExchangeRequest& request, ExchangeReply& reply) {
  if (!vehicles_.Advance(request, 0, reply)) reply.fault = vehicles_.FindFault();
  if (request.record) {
    reply.slides.clear();
    vehicles_.TellSlides(request.ledger, interval_s_ * static_cast<double>(request.exchange + 1), reply.slides);
  }
  if (!request.snapshot) return;
  reply.snapshot.resize(count_);
  vehicles_.Save(reply.snapshot.data());
}

}  // namespace train_dynamics
