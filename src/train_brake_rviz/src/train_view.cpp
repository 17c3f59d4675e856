#include <exception>

#include "train_brake_rviz/view_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "train_view");
  const ros::NodeHandle own("~");  // the node and its log end with the last handle: this one
  try {
    const train_brake_rviz::ViewNode view{ros::NodeHandle(), own};
    ros::spin();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
  return 0;
}
