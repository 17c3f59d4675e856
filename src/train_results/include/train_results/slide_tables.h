#pragma once

#include <filesystem>

#include "train_dynamics/train/slide_results.h"

namespace train_results {

/// Writes a run's tables of slides and of the work on the track into its folder, with units in the headers.
///
/// Empty tables are not written.
///
///   slides.csv      one row per slide of a wheelset, as train_dynamics/vehicle/slide_event.h has it
///   track_wear.csv  one row per metre of track that a wheelset of the 2D model ran over
///
/// @throws std::exception if one could not be written
void WriteSlideTables(const std::filesystem::path& folder, const train_dynamics::SlideResults& slides);

}  // namespace train_results
