#pragma once

#include <string>

namespace train_sim {

/// Writes a folder of one's own that runs at once: a train, a route, a scenario, a launch file, a README.
///
/// Nothing that exists is changed: a folder with anything in it is refused.
/// @throws std::invalid_argument where the folder cannot be taken or written
int StartFolder(const std::string& folder);

}  // namespace train_sim
