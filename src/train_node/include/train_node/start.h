#pragma once

#include <ros/init.h>

#include <cstdint>
#include <string>

namespace train_node {

/// Prepares the process (train_console::PrepareProcess), then ros::init for a node that keeps wall time itself: it
/// neither follows /clock nor logs with another train's time, or with time 0. Simulated time travels in messages.
void InitWithWallTime(int argc, char** argv, const std::string& name, std::uint32_t options = 0);

/// Waits while another process has this node's name, so that a node which is started beside it neither ends it nor
/// is started again and again. Takes the name over from a process that is dead or does not answer. Ctrl-C ends the
/// process meanwhile.
void WaitForOwnName();

}  // namespace train_node
