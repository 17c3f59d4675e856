#pragma once

#include <chrono>
#include <string>

namespace train_node {

/// The process that has a node's name already, as the ROS master and the process itself tell it. A ROS master gives
/// a name to the last node that asks and ends the one that had it, which would end a run; so a node looks first.
struct RunningNode {
  enum class State {
    kNone,    ///< no node is registered, or the registered one does not exist any more (killed, its machine gone)
    kSilent,  ///< a process accepts connections and does not answer: stopped, or in a debugger
    kAlive,
  };
  State state = State::kNone;
  std::string host;   ///< where it runs, as it calls itself
  std::string about;  ///< what it says of itself (service ~identify); empty: it has not said anything
};

/// Name of the service std_srvs/Trigger that tells in its message what a node is doing and since when.
constexpr const char* kIdentifyService = "identify";

/// Looks for the running node that has a name. Needs ros::init, but no registration of this process, and asks nothing
/// but the ROS master and that node. A ROS master that is not there knows of none.
///
/// @param node      full name of the node
/// @param patience  for each answer of that node
RunningNode FindRunningNode(const std::string& node, std::chrono::milliseconds patience);

/// Looks for a running node that has the name of this one, with the patience that a busy machine needs.
RunningNode FindNodeOfOwnName();

}  // namespace train_node
