#pragma once

#include <vector>

#include "train_dynamics/numeric/instruction_set.h"

namespace train_dynamics {

/// Transfers between a train's vehicles and connections at equal distances in it, over the lanes of one instruction
/// set. `stride` is the distance in vehicles, >= 1.
struct RowKernels {
  /// difference[i] = x[i stride] - x[i stride + 1]
  void (*differences)(int count, int stride, const double* x, double* difference);
  /// sum[i] = offset[i] + (x[i stride] - x[i stride + 1])
  void (*offset_differences)(int count, int stride, const double* x, const double* offset, double* sum);
  /// to[i stride] = from[i]
  void (*spread)(int count, int stride, const double* from, double* to);
};

const std::vector<RowKernels>& AllRowKernels();

/// The fastest that this machine can run.
inline const RowKernels& BestRowKernels() { return AllRowKernels().front(); }

extern const RowKernels kScalarRowKernels;
extern const RowKernels kBaseRowKernels;  ///< two lanes: what every x86-64 has
extern const RowKernels kAvx2RowKernels;
extern const RowKernels kAvx512RowKernels;

}  // namespace train_dynamics
