#pragma once

namespace train_run {

/// Exit codes of the programs that run trains.
enum ExitCode {
  kSuccess = 0,
  kFailure = 1,   ///< a file could not be written, ...
  kBadInput = 2,  ///< arguments or configuration
  kSimulationFault = 3,
  kRankFailure = 4,   ///< ltd_master: a wagon node is missing, dead, late or refuses
  kDifferent = 5,     ///< verify: the repetition does not give what was recorded
  kUnreadable = 6,    ///< verify: the recording cannot be compared
  kIncomplete = 7,    ///< verify: the same, as far as the recording goes
  kInterrupted = 130  ///< Ctrl-C; what was simulated is saved and marked incomplete
};

}  // namespace train_run
