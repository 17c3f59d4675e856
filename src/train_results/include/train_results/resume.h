#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/snapshot.h"

namespace train_results {

/// The file of a run's folder that holds its last checkpoint.
inline constexpr const char* kCheckpointFile = "checkpoint";

/// The file of a branch's folder that holds the checkpoint at which it left another run.
inline constexpr const char* kBranchFile = "branched_from";

/// @throws std::invalid_argument naming the file and what is wrong with it
train_dynamics::TrainCheckpoint ReadCheckpoint(const std::filesystem::path& file);

/// The identity of a checkpoint: the resolved scenario as text, with a digest in place of its pressure table's name.
/// Its first line names the version of this program: runs of equal text are the same run, bit for bit.
std::string IdentityOf(const train_dynamics::ScenarioParams& scenario);

/// A run that is resumed from the checkpoint in its folder.
struct ResumedRun {
  std::filesystem::path folder;
  train_dynamics::config::LoadedScenario scenario;
  train_dynamics::TrainCheckpoint checkpoint;
  bool is_branch;  ///< the scenario differs from that of the checkpoint: another run, with results of its own
};

/// Reads folder/config.yaml and folder/checkpoint.
///
/// @param overrides  "path=value": makes it a branch, unless they change nothing. Driver commands, friction,
///                   duration, ... may change; the structure and the time grid of the state may not: the model, the
///                   train's vehicles and connections, dt_s, exchange_, record_ and ledger_interval_s. Nor may anything
///                   before the checkpoint: the start, and commands given until then.
/// @throws std::invalid_argument if there is no checkpoint or it does not fit the scenario; strict_config::Error
ResumedRun LoadResumedRun(const std::filesystem::path& folder, const std::vector<std::string>& overrides);

}  // namespace train_results
