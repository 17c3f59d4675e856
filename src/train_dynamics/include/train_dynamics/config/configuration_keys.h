#pragma once

#include <string>
#include <vector>

#include "strict_config/describer.h"

namespace train_dynamics::config {

/// A kind of configuration file: a scenario, or a part that has files of its own.
struct FileKind {
  std::string name;                                 ///< with which paths begin: "vehicle"
  std::string folder;                               ///< where its files are looked for by name: "vehicles"
  std::string meaning;                              ///< what its files hold
  bool may_be_table = false;                        ///< it may be a CSV file
  std::vector<strict_config::KeyDescription> keys;  ///< of parts within it only that they are parts
};

/// All kinds, the scenario first, then parts in the order of their first use.
std::vector<FileKind> ConfigurationKeys();

}  // namespace train_dynamics::config
