#include "train_dynamics/train/in_process_train.h"

namespace train_dynamics {

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
    vehicles_.TellSlides(request.ledger, interval_s_ * static_cast<double>(request.exchange + 1),
                         reply.slides);
  }
  if (!request.snapshot) return;
  reply.snapshot.resize(count_);
  vehicles_.Save(reply.snapshot.data());
}

}  // namespace train_dynamics
