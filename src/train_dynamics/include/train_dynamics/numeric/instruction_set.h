#pragma once

#include <vector>

namespace train_dynamics {

/// Of the kernels for each instruction set those that were built and that this machine can run, fastest first.
/// All give the same bits.
///
/// @param avx512, avx2  null where they were not built
template <class Kernels>
std::vector<Kernels> RunnableKernels(const Kernels* avx512, const Kernels* avx2, const Kernels& base,
                                     const Kernels& scalar) {
  std::vector<Kernels> runnable;
#if defined(__x86_64__)
  if (avx512 != nullptr && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    runnable.push_back(*avx512);
  }
  if (avx2 != nullptr && __builtin_cpu_supports("avx2")) runnable.push_back(*avx2);
#else
  static_cast<void>(avx512);
  static_cast<void>(avx2);
#endif
  runnable.push_back(base);
  runnable.push_back(scalar);
  return runnable;
}

/// Arrays that kernels step through have a multiple of this many numbers.
inline constexpr int kMostLanes = 8;

/// The next multiple of kMostLanes.
inline constexpr int PaddedToLanes(int count) { return (count + kMostLanes - 1) / kMostLanes * kMostLanes; }

}  // namespace train_dynamics
