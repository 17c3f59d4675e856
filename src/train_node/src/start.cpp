#include "train_node/start.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "train_console/console.h"
#include "train_node/running_node.h"

namespace train_node {

void InitWithWallTime(int argc, char** argv, const std::string& name, std::uint32_t options) {
  train_console::PrepareProcess();
  std::vector<char*> arguments(argv, argv + argc);
  static char wall_time[] = "/use_sim_time:=/nodes_of_the_train_use_wall_time";  // a parameter that is never set
  arguments.push_back(wall_time);
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  ros::init(count, arguments.data(), name, options);
}

void WaitForOwnName() {
  constexpr std::chrono::milliseconds kPeriod(500);
  bool has_told = false;
  void (*const handler)(int) = std::signal(SIGINT, SIG_DFL);  // roscpp's only works in a node that is registered
  for (RunningNode other; (other = FindNodeOfOwnName()).state == RunningNode::State::kAlive;) {
    if (!has_told) {
      ROS_WARN(
          "%s runs already, on %s: this one waits until that one has ended. Another train under the same ROS "
          "master needs a namespace of its own (ROS_NAMESPACE=north roslaunch ...)",
          ros::this_node::getName().c_str(), other.host.c_str());
    }
    has_told = true;
    std::this_thread::sleep_for(kPeriod);
  }
  std::signal(SIGINT, handler);
}

}  // namespace train_node
