#pragma once

namespace train_dynamics {

/// What a record holds of every vehicle.
template <class T>
struct VehicleRecord {
  T head_displacement_m;  ///< of the coupler heads since the start
  T head_velocity_mps;
  T position_m;     ///< of its centre along the track
  T speed_mps;      ///< of the carbody
  T shoe_force_n;   ///< of all shoes, backwards positive
  T wheel_force_n;  ///< longitudinal wheel-rail force, backwards positive; NaN for LTD
  T creepage;       ///< of the wheelset with the largest size; NaN for LTD
};

/// The same as arrays, from the place of one vehicle on.
struct RecordArrays {
  double *head_displacement_m, *head_velocity_mps;
  double *position_m, *speed_mps, *shoe_force_n, *wheel_force_n, *creepage;
};

}  // namespace train_dynamics
