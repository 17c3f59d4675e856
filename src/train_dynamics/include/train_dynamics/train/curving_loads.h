#pragma once

#include <vector>

#include "train_dynamics/track/track.h"
#include "train_dynamics/train/consist.h"
#include "train_dynamics/vehicle/vehicle_loads.h"

namespace train_dynamics {

/// The resistance that curves put on the vehicles of a train:  F = q(R) m,  R at the vehicle's centre.
///
/// Over an exchange it is the mean over the distance that the vehicle will cover at the speed of the exchange's start,
/// so that the work in a curve is right however short the curve.
class CurvingLoads {
 public:
  /// @param start_position_m  of the first vehicle's centre along the track
  CurvingLoads(const TrackParams& track, const Consist& consist, double start_position_m);

  bool empty() const { return types_.empty(); }

  /// Sets the loads over an exchange: an empty array where the track is straight.
  /// @param head_displacement_m, head_velocity_mps  [vehicle] of the coupler heads, at the exchange's start
  void Evaluate(double interval_s, const std::vector<double>& head_displacement_m,
                const std::vector<double>& head_velocity_mps, LoadArrays& loads) const;

 private:
  double Mean(const std::vector<double>& force_n, double from_m, double to_m) const;

  Pieces pieces_;                           ///< of constant curvature
  std::vector<std::vector<double>> types_;  ///< [type of vehicle][piece] F [N]
  std::vector<int> type_;                   ///< [vehicle]
  std::vector<double> start_m_;             ///< [vehicle] centre at the start
};

}  // namespace train_dynamics
