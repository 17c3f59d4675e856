#pragma once

#include <vector>

#include "train_dynamics/track/track.h"

namespace train_brake_rviz {

/// Height of the rail along a track: the integral of its grade from position 0, and its dips.
class Elevation {
 public:
  explicit Elevation(const train_dynamics::TrackParams& track);

  /// [m] above the rail at position 0 without dips
  double operator()(double position_m) const;

  bool IsLevel() const { return grades_.empty() && !track_.has_dips; }
  const train_dynamics::Track& track() const { return track_; }

 private:
  train_dynamics::Track track_;
  std::vector<train_dynamics::StepValue> grades_;
  std::vector<double> height_m_;  ///< [grade] where each begins
};

/// The vertical exaggeration, one of 1, 2, 5, 10 ... 100, with which every stretch of `window_m` that begins
/// between the two positions fits into a height.
///
/// @param scale  of lengths along the track, drawn over real
/// @param room   drawn height that there is
double FittingExaggeration(const Elevation& elevation, double begin_m, double end_m, double window_m, double scale,
                           double room);

}  // namespace train_brake_rviz
