#include <ros/init.h>

#include "wagon_node/wagon_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "wagon");
  wagon_node::WagonNode().Run();
}
