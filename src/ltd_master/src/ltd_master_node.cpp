#include <ros/master.h>

#include <chrono>
#include <exception>
#include <string>
#include <thread>

#include "ltd_master/master_node.h"
#include "strict_config/error_list.h"
#include "train_run/exit_code.h"
#include "train_run/interrupt.h"

namespace {

/// roscpp, too, waits for its ROS master, but deaf to signals. @return whether it is there
bool WaitForRosMaster() {
  for (bool is_first = true; !ros::master::check(); is_first = false) {
    if (is_first) ROS_WARN("waiting for the ROS master at %s", ros::master::getURI().c_str());
    if (train_run::Interrupt() != 0) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

int Run(const ltd_master::MasterOptions& options, const ros::NodeHandle& own) {
  ltd_master::MasterNode master(options, ros::NodeHandle(), own);
  return master.Run();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "ltd_master", ros::init_options::NoSigintHandler);
  train_run::CatchInterrupts();
  if (!WaitForRosMaster()) return train_run::kInterrupted;
  const ros::NodeHandle own("~");  // the node and its log end with the last handle: this one
  int exit_code = train_run::kFailure;
  // First of all parameters: that one of the others is wrong is told there, too.
  const auto exit_status_file = own.param<std::string>("exit_status_file", "");
  try {
    exit_code = Run(ltd_master::MasterOptions::FromParameters(own), own);
  } catch (const strict_config::Error& e) {
    ROS_FATAL("bad configuration:\n%s", e.what());
    exit_code = train_run::kBadInput;
  } catch (const std::invalid_argument& e) {
    ROS_FATAL("%s", e.what());
    exit_code = train_run::kBadInput;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
  }
  if (!exit_status_file.empty()) {
    try {
      train_results::WriteFile(exit_status_file, std::to_string(exit_code) + "\n");
    } catch (const std::exception& e) {
      ROS_FATAL("%s", e.what());
    }
  }
  return exit_code;
}
