#pragma once

#include "train_dynamics/coupler/connection_kernels.h"
#include "train_dynamics/numeric/lanes.h"

/// The laws of connections on arrays, over the scalar type T. Each file of this folder makes one instance and is
/// compiled for its own instruction set; it must use no function that another file could share with it by name, so:
/// packs and plain pointers only.
namespace train_dynamics {

template <class T, class Law>
typename Law::template Memory<T> LoadMemory(const ConnectionArrays& at, int i) {
  typename Law::template Memory<T> memory;
  const double* place = at.memory + i;
  memory.ForEachField([&](T& field) {
    field = Load<T>(place);
    place += at.count;
  });
  return memory;
}

template <class T, class Law>
TRAIN_DYNAMICS_FLATTEN void ConnectionForces(const Law& type, double prediction_s, double time_s,
                                             const ConnectionArrays& at) {
  const Law law = type;  // a copy that no store can change: its numbers stay in registers
  for (int i = 0; i < at.count; i += kLanesOf<T>) {
    typename Law::template Memory<T> memory = LoadMemory<T, Law>(at, i);
    const T rate = Load<T>(at.rate_mps + i);
    GearForce<T> f = ConnectionForce(law, Load<T>(at.extension_m + i) + prediction_s * rate, rate, memory);
    double* place = at.memory + i;
    memory.ForEachField([&](const T& field) {
      Store(field, place);
      place += at.count;
    });
    const auto keep_extreme = [&](MaskOf<T> beyond, double* extreme_n, double* extreme_time_s) {
      if (!AnyOf(beyond)) return;  // most of the time
      Store(Select(beyond, f.force, Load<T>(extreme_n + i)), extreme_n + i);
      Store(Select(beyond, T(time_s), Load<T>(extreme_time_s + i)), extreme_time_s + i);
    };
    if (at.strength_n > 0.0) {
      const T parted = Load<T>(at.parted_s + i);
      const MaskOf<T> was_parted = parted >= T(0.0);
      f.force = Select(was_parted, Min(T(0.0), f.force), f.force);
      const MaskOf<T> breaks = f.force > T(at.strength_n);  // keeps its force among the largest ones
      keep_extreme(breaks & (f.force > Load<T>(at.tension_n + i)), at.tension_n, at.tension_time_s);
      f.force = Select(breaks, T(0.0), f.force);
      f.elastic = Select(was_parted | breaks, Min(T(0.0), f.elastic), f.elastic);
      Store(Select(breaks, T(time_s), parted), at.parted_s + i);
    }
    Store(f.force, at.force_n + i);
    Store(f.elastic, at.elastic_n + i);
    keep_extreme(f.force > Load<T>(at.tension_n + i), at.tension_n, at.tension_time_s);
    keep_extreme(f.force < Load<T>(at.compression_n + i), at.compression_n, at.compression_time_s);
  }
}

template <class T, class Law>
TRAIN_DYNAMICS_FLATTEN void ConnectionWork(const Law& type, const double* extension_m, const ConnectionArrays& at) {
  const Law law = type;
  for (int i = 0; i < at.count; i += kLanesOf<T>) {
    const T end = Load<T>(extension_m + i);
    const T change = end - Load<T>(at.extension_m + i);
    T dissipated;
    if constexpr (Law::kStoresByMemory) {
      T stored = StoredEnergy(law, end, LoadMemory<T, Law>(at, i));
      const MaskOf<T> loose = (Load<T>(at.parted_s + i) >= T(0.0)) & (end > T(0.0));
      stored = Select(loose, T(0.0), stored);
      const T gained = stored - Load<T>(at.stored_j + i);
      dissipated = Load<T>(at.force_n + i) * change - gained;
      if constexpr (Law::kRateIndependent) dissipated = Max(T(0.0), dissipated);
      Store(stored, at.stored_j + i);
    } else {
      dissipated = (Load<T>(at.force_n + i) - Load<T>(at.elastic_n + i)) * change;
    }
    Store(Load<T>(at.dissipated_j + i) + dissipated, at.dissipated_j + i);
    Store(end, at.extension_m + i);
  }
}

/// The kernels of each of the Laws, which are deduced.
template <class T, class... Laws>
constexpr ConnectionKernels KernelsOf(const KernelOfEach<Laws...>* /*laws*/) {
  return {{ConnectionKernel<Laws>{&ConnectionForces<T, Laws>, &ConnectionWork<T, Laws>}...}};
}

template <class T>
constexpr ConnectionKernels ConnectionKernelsOver() {
  return KernelsOf<T>(static_cast<const ConnectionKernels*>(nullptr));
}

extern const ConnectionKernels kScalarConnectionKernels;
extern const ConnectionKernels kBaseConnectionKernels;  ///< two lanes: what every x86-64 has
extern const ConnectionKernels kAvx2ConnectionKernels;
extern const ConnectionKernels kAvx512ConnectionKernels;

}  // namespace train_dynamics
