#pragma once

#include <map>
#include <string>
#include <vector>

#include "train_dynamics/config/configuration_keys.h"

namespace train_sim {

/// A value of a key, taken from a file.
struct KeyExample {
  std::string value;  ///< as YAML
  std::string file;   ///< "vehicles/ore_wagon.yaml"; empty: no shipped file has it
};

/// Examples from the files in the folders of TRAIN_BRAKE_CONFIG, by path: "vehicle.wheel_rail.adhesion", entries of
/// lists without an index. For keys that none of them has, those of the same key elsewhere in the kind, or made ones.
std::map<std::string, KeyExample> FindExamples(const std::vector<train_dynamics::config::FileKind>& kinds);

}  // namespace train_sim
