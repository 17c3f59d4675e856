#pragma once

#include <vector>

#include "train_dynamics/coupler/connection.h"
#include "train_dynamics/numeric/instruction_set.h"

namespace train_dynamics {

/// Connections of one law, side by side: one number each, in arrays of `count`, a multiple of kMostLanes.
struct ConnectionArrays {
  int count;
  double strength_n;                           ///< 0: never breaks
  const double* rate_mps;                      ///< of the extension
  double* extension_m;                         ///< at the last exchange
  double* memory;                              ///< of the law, [field][connection]
  double *force_n, *elastic_n;                 ///< tension positive
  double *tension_n, *tension_time_s;          ///< the largest so far, and when
  double *compression_n, *compression_time_s;  ///< the same, <= 0
  double *stored_j, *dissipated_j;             ///< at the last exchange, of a law that stores by memory; so far
  double* parted_s;                            ///< when it broke; < 0: it has not
};

/// A law of connections over the lanes of one instruction set.
template <class Law>
struct ConnectionKernel {
  /// Forces at the extension that is predicted `prediction_s` ahead; largest forces are booked at `time_s`.
  void (*forces)(const Law& law, double prediction_s, double time_s, const ConnectionArrays& arrays);
  /// Moves the connections to these extensions [m] and books the work of their friction.
  void (*work)(const Law& law, const double* extension_m, const ConnectionArrays& arrays);
};

template <class... Laws>
struct KernelOfEach : ConnectionKernel<Laws>... {};

/// All laws of connections over the lanes of one instruction set.
struct ConnectionKernels : OfConnectionLaws<KernelOfEach> {
  template <class Law>
  const ConnectionKernel<Law>& Of(const Law& /*law*/) const {
    return *this;
  }
};

const std::vector<ConnectionKernels>& AllConnectionKernels();

/// The fastest that this machine can run.
inline const ConnectionKernels& BestConnectionKernels() { return AllConnectionKernels().front(); }

}  // namespace train_dynamics
