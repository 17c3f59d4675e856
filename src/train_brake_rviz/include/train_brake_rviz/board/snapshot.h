#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "train_dynamics/train/lockstep.h"

namespace train_brake_rviz {

/// A train at one instant, as far as it is known: arrays are [vehicle] from the front, [connection] for
/// forces, or empty. SI units.
struct Snapshot {
  double time_s = 0.0;
  double real_time_factor = 0.0;
  std::vector<double> position_m, speed_mps, acceleration_mps2, creepage;
  std::vector<double> coupler_force_n;
  std::vector<double> cylinder_pressure_pa;
  std::vector<double> pipe_pressure_pa;              ///< empty if the brake has no pipe
  std::optional<train_dynamics::WagonDetail> wagon;  ///< the followed one, if it is recorded in full detail
};

}  // namespace train_brake_rviz
