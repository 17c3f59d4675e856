#pragma once

#include <string>

namespace train_sim {

struct VerifyOptions {
  std::string recording;  ///< folder of a run, or bag
  std::string config;     ///< scenario of the run; empty: the folder's or the bag's own
  std::string train;      ///< namespace of the train in the bag; empty: the only one
  int threads = 0;        ///< 0: as in RunOptions
};

/// Repeats a recorded run in this process and compares it record by record, bit by bit: digests first, then every
/// recorded value. Prints the verdict.
/// @return train_run::kSuccess, train_run::kDifferent, train_run::kUnreadable, train_run::kIncomplete or
///   train_run::kInterrupted
int Verify(const VerifyOptions& options);

}  // namespace train_sim
