#pragma once

#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"

namespace ltd_master {

/// How a command of train_sim ends.
enum ExitCode {
  kSuccess = 0,
  kFailure = 1,   ///< a file could not be written, ...
  kBadInput = 2,  ///< arguments or configuration
  kSimulationFault = 3,
  kRankFailure = 4,   ///< ltd_master: a wagon node is missing, dead, late or refuses
  kDifferent = 5,     ///< verify: the repetition does not give what was recorded
  kUnreadable = 6,    ///< verify: nothing can be told
  kIncomplete = 7,    ///< verify: the same, as far as the recording goes
  kInterrupted = 130  ///< Ctrl-C; what was simulated is saved and marked incomplete
};

struct RunOptions {
  std::string scenario;
  std::string model;   ///< empty: the scenario's
  std::string out;     ///< empty: nothing is written
  std::string resume;  ///< folder of a run that goes on from its checkpoint; instead of a scenario
  double checkpoint_interval_s = 10.0;  ///< of simulated time; 0: none
  bool go_on_without_records = false;   ///< where results cannot be written
  std::vector<std::string> overrides;
  int threads = 0;  ///< 0: one per core for the 2D model, one for LTD
  bool csv = false;
};

/// As many as asked for, if any, else one per core; but no more than are useful.
int Threads(int asked, const train_dynamics::config::LoadedScenario& scenario);

/// Simulates a scenario with all vehicles in this process.
/// @throws train_dynamics::config::Error, std::exception
int RunScenario(const RunOptions& options);

}  // namespace ltd_master
