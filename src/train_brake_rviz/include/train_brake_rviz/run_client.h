#pragma once

#include <ros/node_handle.h>
#include <train_brake_msgs/DriverCommand.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace train_brake_rviz {

/// The outcome of a request, in words for the user.
struct Answer {
  bool success = false;
  std::string message;
};

/// Asks a running train: the services of its master, and of the view that shows it. A call waits for the
/// answer.
class RunClient {
 public:
  /// @param train  in the train's namespace
  explicit RunClient(const ros::NodeHandle& train) : train_(train) {}

  Answer Resume();
  Answer Pause();
  Answer Step(unsigned exchanges);
  Answer SetRealTimeFactor(double factor);
  Answer Give(const train_brake_msgs::DriverCommand& command);
  /// @param quantity, vehicle  as in SelectView
  Answer Select(const std::string& quantity, int vehicle);

 private:
  template <class Service>
  Answer Call(const std::string& name, Service& service);

  ros::NodeHandle train_;
};

/// A thread that executes tasks in order, so that a window need not wait.
class Worker {
 public:
  Worker();
  /// Finishes the present task and drops the others.
  ~Worker();
  void Do(std::function<void()> task);

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace train_brake_rviz
