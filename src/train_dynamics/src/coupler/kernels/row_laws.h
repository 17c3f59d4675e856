#pragma once

#include <type_traits>

#include "train_dynamics/coupler/row_kernels.h"

/// As connection_laws.h. The packs are those that the compiler forms; T only distinguishes the instances.
namespace train_dynamics {

/// Calls loop(stride); with the strides of most trains as constants, over which the compiler forms packs.
template <class T, class Loop>
void WithStride(int stride, const Loop& loop) {
  if (stride == 1) {
    loop(std::integral_constant<int, 1>());
  } else if (stride == 2) {
    loop(std::integral_constant<int, 2>());
  } else {
    loop(stride);
  }
}

template <class T>
TRAIN_DYNAMICS_FLATTEN void Differences(int count, int stride, const double* __restrict x,
                                        double* __restrict difference) {
  WithStride<T>(stride, [=](auto by) {
    for (int i = 0; i < count; ++i) difference[i] = x[i * by] - x[i * by + 1];
  });
}

template <class T>
TRAIN_DYNAMICS_FLATTEN void OffsetDifferences(int count, int stride, const double* __restrict x,
                                              const double* __restrict offset, double* __restrict sum) {
  WithStride<T>(stride, [=](auto by) {
    for (int i = 0; i < count; ++i) sum[i] = offset[i] + (x[i * by] - x[i * by + 1]);
  });
}

template <class T>
TRAIN_DYNAMICS_FLATTEN void Spread(int count, int stride, const double* __restrict from, double* __restrict to) {
  WithStride<T>(stride, [=](auto by) {
    for (int i = 0; i < count; ++i) to[i * by] = from[i];
  });
}

template <class T>
constexpr RowKernels RowKernelsOver() {
  return {&Differences<T>, &OffsetDifferences<T>, &Spread<T>};
}

}  // namespace train_dynamics
