#include <ros/console.h>
#include <ros/this_node.h>

#include <exception>

#include "train_console/console.h"
#include "train_node/start.h"
#include "wagon_node/wagon_node.h"

int main(int argc, char** argv) {
  constexpr int kBadInput = 2;
  train_node::InitWithWallTime(argc, argv, "wagon");
  train_node::WaitForOwnName();
  try {
    train_node::NodeParameters parameters(ros::this_node::getName());
    const auto options = wagon_node::WagonOptions::FromParameters(parameters);
    wagon_node::WagonNode(options).Run();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", train_console::Presentable(e.what()).c_str());
    return kBadInput;
  }
  return 0;
}
