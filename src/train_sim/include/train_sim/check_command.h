#pragma once

#include <string>
#include <vector>

namespace train_sim {

struct CheckOptions {
  std::string scenario;
  std::string model;  ///< empty: the scenario's
  std::string out;    ///< folder for results, for its free space; empty: not asked
  std::vector<std::string> overrides;
  int threads = 0;    ///< as in RunOptions
  int nodes = 0;      ///< wagon nodes; 0: a run in one process
  int machines = 1;   ///< that share them
  bool json = false;  ///< print one JSON object for programs, and nothing for people
};

/// Checks a scenario, prints its contents and the effort of a run; a doubtful setting is a warning with its place and a
/// remedy.
/// @throws strict_config::Error
int CheckScenario(const CheckOptions& options);

/// Prints a scenario with its parts, defaults and overrides resolved, as YAML that runs again to the same bits.
/// @throws strict_config::Error
int ResolveScenario(const std::string& scenario, const std::vector<std::string>& overrides);

}  // namespace train_sim
