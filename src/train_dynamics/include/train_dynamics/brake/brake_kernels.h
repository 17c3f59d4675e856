#pragma once

#include <vector>

#include "train_dynamics/brake/air_brake.h"
#include "train_dynamics/numeric/instruction_set.h"

namespace train_dynamics {

/// Cylinder pressures by recurrence, one number per vehicle.
struct GapArrays {
  double *target_pa, *gap_pa, *decay;
};

/// The laws of cylinders over the lanes of one instruction set, of `count` vehicles, a multiple of kMostLanes.
struct BrakeKernels {
  /// Pressures at a time.
  void (*cylinder_pressures)(const BrakePhases& phases, double time_s, int count, double* pressure_pa);
  /// Gaps to the targets at a time, and the factor by which they shrink in dt.
  void (*cylinder_gaps)(const BrakePhases& phases, double time_s, double dt_s, int count, const GapArrays& arrays);
  /// Advances the gaps by `steps` times dt, and gives the pressures then.
  void (*close_cylinder_gaps)(int steps, int count, const GapArrays& arrays, double* pressure_pa);
};

const std::vector<BrakeKernels>& AllBrakeKernels();

/// The fastest that this machine can run.
inline const BrakeKernels& BestBrakeKernels() { return AllBrakeKernels().front(); }

}  // namespace train_dynamics
