#include <ros/this_node.h>

#include <exception>

#include "train_brake_rviz/view_node.h"
#include "train_node/caller.h"
#include "train_node/running_node.h"
#include "train_node/start.h"

int main(int argc, char** argv) {
  constexpr int kBadInput = 2;
  train_node::InitWithWallTime(argc, argv, "train_view");
  const std::string& name = ros::this_node::getName();
  const train_node::RunningNode other = train_node::FindNodeOfOwnName();
  if (other.state == train_node::RunningNode::State::kAlive) {
    ROS_FATAL("%s runs already, on %s: it goes on, and its pictures serve any number of rviz", name.c_str(),
              other.host.c_str());
    return kBadInput;
  }
  const ros::NodeHandle own("~");  // the node and its log end with the last handle: this one
  try {
    train_node::EnterCallerFolder();
    train_node::NodeParameters parameters(name);
    const train_brake_rviz::ViewNode view{ros::NodeHandle(), own, parameters};
    ros::spin();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return kBadInput;
  }
  return 0;
}
