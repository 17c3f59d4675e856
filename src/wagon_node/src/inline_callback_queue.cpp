#include "wagon_node/inline_callback_queue.h"

#include <thread>

namespace wagon_node {

void InlineCallbackQueue::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t /*owner*/) {
  while (callback->call() == ros::CallbackInterface::TryAgain) std::this_thread::yield();
}

void InlineCallbackQueue::removeByID(std::uint64_t /*owner*/) {}  // nothing ever waits

}  // namespace wagon_node
