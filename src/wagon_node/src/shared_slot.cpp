#include "wagon_node/shared_slot.h"

#include <sched.h>

#include <stdexcept>

namespace wagon_node {

using train_brake_msgs::ExchangeHead;
using train_brake_msgs::YieldUntil;

SharedSlot::SharedSlot(const train_brake_msgs::ConfigureRequest& offer)
    : memory_(offer.memory_pid, offer.memory_descriptor, offer.run_id), slot_(offer.memory_slot) {
  if (slot_ >= memory_.layout().slots) throw std::runtime_error("there is no such slot");
  served_ = memory_.request(slot_).call();
}

bool SharedSlot::Wait(double timeout_s) {
  ExchangeHead& head = memory_.head();
  const std::uint32_t seen = head.requests.count();
  if (memory_.request(slot_).call() != served_) return true;
  // There may be a core for each thread of the ranks; but one of them is the master's, which works next.
  const bool has_core = head.threads <= cores_ && head.master_core != static_cast<std::uint32_t>(sched_getcpu());
  const bool is_notified = has_core ? spin_.Spin(head.requests, seen) : YieldUntil(head.requests, seen, head.yields);
  if (!is_notified) head.requests.Wait(seen, timeout_s);
  return memory_.request(slot_).call() != served_;
}

void SharedSlot::Read(train_brake_msgs::StepRequest& request) {
  train_brake_msgs::MessageBuffer& buffer = memory_.request(slot_);
  served_ = buffer.call();
  if (!buffer.Read(request, memory_.layout().request_room)) throw std::runtime_error("it does not fit its slot");
}

void SharedSlot::Reply(const train_brake_msgs::StepResponse& response) {
  ExchangeHead& head = memory_.head();
  memory_.reply(slot_).Write(served_, response, memory_.layout().reply_room);
  const bool is_last = head.unreplied.fetch_sub(1) <= 1;
  if (!is_last) return;
  head.last_slot.store(slot_);
  head.replies.Notify();
}

}  // namespace wagon_node
