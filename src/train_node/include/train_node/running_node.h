#pragma once

#include <chrono>
#include <string>

namespace train_node {

/// A process that already has a node's name, as reported by the ROS master and the process itself. A ROS master gives a
/// name to the last node that requests it and ends the one that had it, which would end a run; so a node checks first.
struct RunningNode {
  enum class State {
    kNone,    ///< no node is registered, or the registered one does not exist any more (killed, its machine gone)
    kSilent,  ///< a process accepts connections and does not answer: stopped, or in a debugger
    kAlive,
  };
  State state = State::kNone;
  std::string host;   ///< the machine's name, as the process reports it
  std::string about;  ///< its description (service ~identify); empty: it has not given one
};

/// Name of the service std_srvs/Trigger whose message says what a node is doing and since when.
constexpr const char* kIdentifyService = "identify";

/// Looks for the running node that has a name. Needs ros::init, but no registration of this process, and queries only
/// the ROS master and that node. Without a ROS master there is none.
///
/// @param node      full name of the node
/// @param patience  for each answer of that node
RunningNode FindRunningNode(const std::string& node, std::chrono::milliseconds patience);

/// Looks for a running node that has the name of this one, with the patience that a busy machine needs.
RunningNode FindNodeOfOwnName();

}  // namespace train_node
