#pragma once

#include <string>
#include <vector>

namespace ltd_master {

/// Prints the natural modes of a vehicle's 2D model and its largest stable step.
int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides);

/// Prints the coefficient of adhesion over the creepage at several speeds, under the static wheel load.
/// @param csv  comma-separated instead of aligned
int PrintAdhesion(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv);

}  // namespace ltd_master
