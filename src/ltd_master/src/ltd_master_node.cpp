#include <fmt/format.h>
#include <ros/master.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ltd_master/master_node.h"
#include "strict_config/error_list.h"
#include "train_console/console.h"
#include "train_node/caller.h"
#include "train_node/node_parameters.h"
#include "train_node/running_node.h"
#include "train_node/start.h"
#include "train_results/plain_file.h"
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

/// Ends this process if another one has its name: registering would end that one's run.
void RefuseTakenName() {
  using train_node::RunningNode;
  const RunningNode other = train_node::FindNodeOfOwnName();
  if (other.state == RunningNode::State::kNone) return;
  const std::string about = other.state == RunningNode::State::kSilent ? "it does not answer; stopped, or in a debugger"
                            : other.about.empty()                      ? "it is starting"
                                                                       : other.about;
  throw std::invalid_argument(
      fmt::format("{0} runs already under the ROS master {1}, on {2}: {3}. It goes on, and nothing was started here. "
                  "A second train needs a namespace of its own, which its topics and services get, too:\n"
                  "  ROS_NAMESPACE=north roslaunch train_brake ...    # /north{0}",
                  ros::this_node::getName(), ros::master::getURI(), other.host, about));
}

/// Warns of parameters that others left on the ROS master and that a node started by hand would use.
void TellStaleParameters(const train_node::NodeParameters& parameters, const std::vector<std::string>& arguments) {
  std::vector<std::string> stale;
  for (const std::string& name : parameters.Names()) {
    const std::string given = "_" + name + ":=";
    const auto is_given = [&](const std::string& argument) {
      return argument.rfind(given, 0) == 0 ||
             argument.rfind("__log:=", 0) == 0;  // roslaunch gives a log, and all of them
    };
    if (std::none_of(arguments.begin(), arguments.end(), is_given)) stale.push_back(name);
  }
  if (stale.empty()) return;
  ROS_WARN("these parameters were on the ROS master before, and are used: %s (rosparam delete %s forgets them)",
           fmt::format("{}", fmt::join(stale, ", ")).c_str(), ros::this_node::getName().c_str());
}

/// The file that gets the exit code, through links. An earlier run's file is removed, so that it is not mistaken for
/// this one's. Throws std::invalid_argument if it cannot be written: before the run, not after it.
std::string MakeReady(const std::string& exit_status_file) {
  namespace fs = std::filesystem;
  try {
    const fs::path file = fs::weakly_canonical(train_node::ExpandHome(exit_status_file));
    if (fs::exists(file) && !fs::is_regular_file(file))
      throw std::runtime_error(file.string() + " is not a regular file");
    train_results::WriteFile(file, "");
    fs::remove(file);
    return file;
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument(std::string("exit_status_file: ") + e.what() + "; nothing was started");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  train_node::InitWithWallTime(argc, argv, "ltd_master", ros::init_options::NoSigintHandler);
  train_run::CatchInterrupts();
  if (!WaitForRosMaster()) return train_run::kInterrupted;
  train_node::NodeParameters parameters(ros::this_node::getName());
  // Before all other parameters: an error in one of them is also written there.
  const std::string wanted_status_file = parameters.Text("exit_status_file", "");
  std::string exit_status_file;
  std::optional<ros::NodeHandle> own;  // the node and its log end with the last handle: this one
  int exit_code = train_run::kFailure;
  try {
    train_node::EnterCallerFolder();
    if (!wanted_status_file.empty()) exit_status_file = MakeReady(wanted_status_file);
    RefuseTakenName();
    own.emplace("~");
    TellStaleParameters(parameters, arguments);
    const auto options = ltd_master::MasterOptions::FromParameters(parameters, ros::this_node::getNamespace());
    exit_code = ltd_master::MasterNode(options, ros::NodeHandle(), *own).Run();
  } catch (const strict_config::Error& e) {
    ROS_FATAL("bad configuration:\n%s", train_console::Presentable(e.what()).c_str());
    exit_code = train_run::kBadInput;
  } catch (const std::invalid_argument& e) {
    ROS_FATAL("%s", train_console::Presentable(e.what()).c_str());
    exit_code = train_run::kBadInput;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", train_console::Presentable(e.what()).c_str());
  }
  if (!exit_status_file.empty()) {
    try {
      train_results::WriteFile(exit_status_file, std::to_string(exit_code) + "\n");
    } catch (const std::exception& e) {
      ROS_FATAL("%s", train_console::Presentable(e.what()).c_str());
      if (exit_code == train_run::kSuccess) exit_code = train_run::kFailure;
    }
  }
  return exit_code;
}
