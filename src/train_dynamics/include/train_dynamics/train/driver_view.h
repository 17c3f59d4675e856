#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "train_dynamics/track/track.h"
#include "train_dynamics/train/command_schedule.h"
#include "train_dynamics/train/consist.h"

namespace train_dynamics {

/// What holds from a place on: a speed limit [m/s], infinite where there is none, or a grade [-], uphill positive.
struct PlaceAhead {
  double from_m;
  double value;
};

/// What a driver sees and knows at the start of an exchange; positions are along the track, ahead is where they rise.
///
/// A driver, in the master's process or behind a service, is given this and nothing else. It is a function of the
/// train's state at that exchange, so that a driver that depends on nothing else repeats its run bit for bit.
struct DriverView {
  std::uint64_t exchange = 0;
  double time_s = 0.0;
  double position_m = 0.0;                    ///< of the first vehicle's centre: by it conditions and stops are judged
  double front_m = 0.0, rear_m = 0.0;         ///< ends of the train
  double speed_mps = 0.0;                     ///< of the first vehicle, as its speedometer has it; forward positive
  double speed_limit_mps = 0.0;               ///< the lowest under the train; infinite where there is none
  double mean_grade = 0.0;                    ///< [-] under the vehicles, by their masses; uphill positive
  std::vector<PlaceAhead> limits_ahead;       ///< from front_m (not included) as far as is seen
  std::vector<PlaceAhead> grades_ahead;       ///< likewise
  std::vector<StationParams> stations_ahead;  ///< those that position_m has not passed, likewise
  double throttle_notch = 0.0, dynamic_brake_notch = 0.0;  ///< that the first locomotive obeys
  double effort_n = 0.0;                ///< at the rims of all locomotives: traction positive, dynamic brake negative
  double reduction_kpa = 0.0;           ///< of the brake pipe, as last commanded; 0 after a release
  bool emergency = false;               ///< was commanded, and no release since
  double brake_pipe_kpa = 0.0;          ///< gauge, at the first vehicle; NaN: the brake has no pipe that is computed
  double cylinder_kpa = 0.0;            ///< gauge, of the first vehicle
  double mean_cylinder_kpa = 0.0;       ///< gauge, of all vehicles
  std::vector<double> coupler_force_n;  ///< [connection] in the coming interval, tension positive; empty: not shown
};

/// Sets the position of the driver's brake handle at a time, from the commands with a time and from those that were
/// given.
/// @param initial_reduction_kpa  at time 0
void SetBrakeHandle(double initial_reduction_kpa, const std::vector<DriverCommand>& commands,
                    const std::vector<GivenCommand>& given, double time_s, double exchange_interval_s,
                    DriverView& view);

/// Fills the part of a view that describes the track under and ahead of a train: speed limits, grades, stations.
class RouteSight {
 public:
  /// @param start_position_m  of the first vehicle's centre along the track
  RouteSight(const TrackParams& track, const Consist& consist, double start_position_m);

  /// @param displacement_m  [vehicle] since the start; forward positive
  /// @param ahead_m         how far the driver sees and knows the line, from the front of the train; >= 0
  void Look(const std::vector<double>& displacement_m, double ahead_m, DriverView& view) const;

 private:
  Track track_;
  std::vector<StationParams> stations_;    ///< by rising position
  std::vector<double> start_m_;            ///< [vehicle] centre at the start
  std::vector<double> mass_share_;         ///< [vehicle] of the train's mass
  double front_offset_m_, rear_offset_m_;  ///< half lengths of the first and of the last vehicle
};

}  // namespace train_dynamics
