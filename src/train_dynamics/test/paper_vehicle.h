#pragma once

#include <string>

#include "strict_config/reader.h"
#include "train_dynamics/vehicle/vehicle_params.h"

namespace train_dynamics {

/// Reads a part of the project's own configuration, e.g. "vehicles/ore_wagon.yaml".
template <class Params>
Params LoadPart(const std::string& file) {
  const std::string config = TRAIN_BRAKE_CONFIG_DIR;
  strict_config::LoadOptions options;
  options.search_roots = {config};
  options.kind = file.substr(0, file.find('/'));
  return strict_config::Load<Params>(config + "/" + file, options);
}

/// The paper's wagon.
inline const VehicleParams& OreWagon() {
  static const VehicleParams wagon = LoadPart<VehicleParams>("vehicles/ore_wagon.yaml");
  return wagon;
}

}  // namespace train_dynamics
