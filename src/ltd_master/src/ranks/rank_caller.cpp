#include "ltd_master/ranks/rank_caller.h"

#include <ros/master.h>

namespace ltd_master {

std::string WhyNotFound() {
  if (ros::master::check()) return "has not advertised";
  return "cannot be looked up: the ROS master at " + ros::master::getURI() + " does not answer";
}

}  // namespace ltd_master
