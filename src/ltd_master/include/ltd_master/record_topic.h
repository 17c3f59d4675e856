#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <mutex>
#include <optional>
#include <string>

namespace ltd_master {

/// A topic of every record that also serves subscribers that arrive during a pause: they get the last record, so that a
/// recorder started in a pause has everything from there on. (A latched topic would do the same, but convert and
/// serialise every record even without subscribers.)
template <class Message>
class RecordTopic {
 public:
  RecordTopic(ros::NodeHandle& node, const std::string& name, std::uint32_t queue) {
    publisher_ = node.advertise<Message>(name, queue, [this](const ros::SingleSubscriberPublisher& newcomer) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (held_) newcomer.publish(*held_);
    });
  }

  /// A new record. @param make  makes the message; not called without subscribers
  template <class Make>
  void Publish(const Make& make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      held_.reset();
    }
    if (publisher_.getNumSubscribers() > 0) publisher_.publish(make());
  }

  /// The run is paused: subscribers that arrive before the next record get this last one.
  template <class Make>
  void Hold(const Make& make) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!held_) held_ = make();
  }

 private:
  std::mutex mutex_;  ///< between the thread of the run and the threads that handle subscribers
  std::optional<Message> held_;
  ros::Publisher publisher_;
};

}  // namespace ltd_master
