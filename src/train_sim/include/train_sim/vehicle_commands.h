#pragma once

#include <string>
#include <vector>

namespace train_sim {

enum class ModesFormat {
  kText,  ///< an aligned table for people, with the motions that have the largest shares of the energy
  kCsv,   ///< comma-separated, with the whole shapes
  kJson   ///< one JSON object: what the table for people says
};

/// Prints the natural modes of a vehicle's 2D model and its largest stable step.
int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides, ModesFormat format);

/// Prints the coefficient of adhesion over the creepage at several speeds, under the static wheel load.
/// @param csv  comma-separated instead of aligned
int PrintAdhesion(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv);

}  // namespace train_sim
