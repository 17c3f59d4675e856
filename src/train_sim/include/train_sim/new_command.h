#pragma once

#include <string>

namespace train_sim {

/// Writes a folder that the user owns and can run at once: a train, a route, a scenario, a launch file, a README.
///
/// Nothing that exists is changed: a folder that is not empty is refused.
/// @throws std::invalid_argument if the folder is not empty or cannot be written
int StartFolder(const std::string& folder);

}  // namespace train_sim
