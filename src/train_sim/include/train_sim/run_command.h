#pragma once

#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_run/exit_code.h"

namespace train_sim {

inline constexpr double kTwinOffset = 1e-9;  ///< [km/h]

struct RunOptions {
  std::string scenario;
  std::string model;                    ///< empty: the scenario's
  std::string out;                      ///< empty: nothing is written
  std::string resume;                   ///< folder of a run to resume from its checkpoint; instead of a scenario
  double checkpoint_interval_s = 10.0;  ///< of simulated time; 0: none
  bool go_on_without_records = false;   ///< where results cannot be written
  std::vector<std::string> overrides;
  int threads = 0;  ///< 0: one per core for the 2D model, one for LTD
  bool csv = false;
  bool json = false;  ///< print the contents of summary.json, and nothing for people
  bool twin = false;  ///< also run a twin whose start differs by kTwinOffset, and report how far it diverges
};

/// The number requested, if any, else one per core; but no more than are useful.
int Threads(int asked, const train_dynamics::config::LoadedScenario& scenario);

/// Simulates a scenario with all vehicles in this process.
/// @throws strict_config::Error, std::exception
int RunScenario(const RunOptions& options);

/// Prints the main results of a finished run again.
/// @param folder  of its results
/// @throws std::invalid_argument if its summary.json does not exist or is invalid
int TellSummary(const std::string& folder);

}  // namespace train_sim
