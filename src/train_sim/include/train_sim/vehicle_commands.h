#pragma once

#include <string>
#include <vector>

namespace train_sim {

/// Prints the natural modes of a vehicle's 2D model and its largest stable step.
/// @param csv  comma-separated, with the whole shapes
int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv);

/// Prints the coefficient of adhesion over the creepage at several speeds, under the static wheel load.
/// @param csv  comma-separated instead of aligned
int PrintAdhesion(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv);

}  // namespace train_sim
