#pragma once

#include <map>
#include <string>
#include <vector>

#include "train_dynamics/config/configuration_keys.h"

namespace train_sim {

/// A value of a key that stands in a file.
struct KeyExample {
  std::string value;  ///< as YAML
  std::string file;   ///< "vehicles/ore_wagon.yaml"
};

/// An example of each key that any file in the folders of TRAIN_BRAKE_CONFIG has, by path:
/// "vehicle.wheel_rail.adhesion", entries of lists without an index.
std::map<std::string, KeyExample> FindExamples(const std::vector<train_dynamics::config::FileKind>& kinds);

}  // namespace train_sim
