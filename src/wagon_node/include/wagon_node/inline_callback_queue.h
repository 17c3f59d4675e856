#pragma once

#include <ros/callback_queue_interface.h>

namespace wagon_node {

/// A callback queue without a queue: a callback runs at once, in the thread of roscpp that added it.
///
/// This saves a thread that spins a queue. While a callback runs, nothing else of the node's network is served.
class InlineCallbackQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) override;
  void removeByID(std::uint64_t owner) override;
};

}  // namespace wagon_node
