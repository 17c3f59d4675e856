#include "train_dynamics/train/in_process_train.h"

namespace train_dynamics {

void InProcessTransport::Start(ExchangeReply& reply) { vehicles_.Report(0, true, reply); }

void InProcessTransport::Exchange(const ExchangeRequest& request, ExchangeReply& reply) {
  if (!vehicles_.Advance(request, 0, reply)) reply.fault = vehicles_.FindFault();
}

}  // namespace train_dynamics
