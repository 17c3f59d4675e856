#pragma once

#include <string>

namespace train_node {

/// Environment variable with the folder in which the user called roslaunch, which runs its nodes in ROS_HOME.
constexpr const char* kCallerFolder = "TRAIN_BRAKE_CALLER_FOLDER";

/// Makes the caller's folder the working folder of this process, so that relative paths mean what they mean in the
/// caller's shell. Does nothing where the variable is not set: then the working folder is the caller's already.
/// @throws std::invalid_argument if there is no such folder
void EnterCallerFolder();

/// A path with "~" or "~/" at its beginning replaced by the home folder, as a shell does in arguments of other forms.
/// @throws std::invalid_argument for another user's home folder ("~anna/runs"), or if HOME is not set
std::string ExpandHome(const std::string& path);

}  // namespace train_node
