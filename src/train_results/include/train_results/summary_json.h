#pragma once

#include <string>

#include "train_dynamics/train/run_summary.h"
#include "train_dynamics/train/train_master.h"

namespace train_results {

/// The contents of summary.json: the results of a run. Keys carry their units; a value that does not exist is null;
/// every number reads back to the same bits.
///
/// @param wall_s wall time of this process [s]
/// @param fault   why the run ended early; empty: it did not, or was interrupted
std::string SummaryJson(const train_dynamics::RunSummary& summary, const train_dynamics::TrainMaster& master,
                        double wall_s, const std::string& fault);

}  // namespace train_results
