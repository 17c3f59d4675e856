#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace train_node {

/// Keeps this node known to its ROS master. A restarted ROS master knows no node, and roscpp registers a topic or
/// service only once: nodes started later would never find them.
///
/// Asks the ROS master every `period` whether it knows this node, and otherwise registers all its topics and services
/// again. Connections that exist are left as they are.
class RegistrationWatch {
 public:
  /// @param services  names of the node's services -> their URI; empty: that of roscpp's own server
  /// @param restored  called after each registration, by a thread of the watch's own
  RegistrationWatch(std::chrono::milliseconds period, std::map<std::string, std::string> services,
                    std::function<void()> restored = nullptr);
  RegistrationWatch(const RegistrationWatch&) = delete;
  RegistrationWatch& operator=(const RegistrationWatch&) = delete;
  ~RegistrationWatch();

 private:
  void Look();

  std::map<std::string, std::string> services_;
  std::function<void()> restored_;
  bool is_master_gone_ = false;
  std::mutex mutex_;
  std::condition_variable ended_changed_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace train_node
