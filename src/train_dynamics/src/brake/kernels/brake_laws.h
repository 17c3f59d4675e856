#pragma once

#include "train_dynamics/brake/brake_kernels.h"
#include "train_dynamics/numeric/lanes.h"

/// The laws of cylinders on arrays, over the scalar type T. Each file of this folder makes one instance and is compiled
/// for its own instruction set; it must use no function that another file could share with it by name, so: packs and
/// plain pointers only.
namespace train_dynamics {

template <class T>
void CylinderPressures(const BrakePhases& phases, double time_s, int count, double* pressure_pa) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    Store(CylinderPressure<T>(phases, i, time_s), pressure_pa + i);
  }
}

template <class T>
void CylinderGaps(const BrakePhases& phases, double time_s, double dt_s, int count, const GapArrays& at) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    const CylinderGap<T> gap = CylinderGapAt<T>(phases, i, time_s);
    Store(gap.target_pa, at.target_pa + i);
    Store(gap.gap_pa, at.gap_pa + i);
    Store(Exp(-gap.rate_per_s * dt_s), at.decay + i);
  }
}

template <class T>
void CloseCylinderGaps(int steps, int count, const GapArrays& arrays, double* pressure_pa) {
  const GapArrays at = arrays;  // a copy that no store can change
  const auto close = [&](const auto& advanced) {
    for (int i = 0; i < count; i += kLanesOf<T>) {
      const T gap = advanced(Load<T>(at.gap_pa + i), Load<T>(at.decay + i));
      Store(gap, at.gap_pa + i);
      Store(Load<T>(at.target_pa + i) + gap, pressure_pa + i);
    }
  };
  if (steps == 2) {  // from the middle of one exchange to that of the next
    close([](T gap, T decay) { return gap * decay * decay; });
    return;
  }
  close([steps](T gap, T decay) {
    for (int step = 0; step < steps; ++step) gap = gap * decay;
    return gap;
  });
}

template <class T>
constexpr BrakeKernels BrakeKernelsOver() {
  return {&CylinderPressures<T>, &CylinderGaps<T>, &CloseCylinderGaps<T>};
}

extern const BrakeKernels kScalarBrakeKernels;
extern const BrakeKernels kBaseBrakeKernels;  ///< two lanes: what every x86-64 has
extern const BrakeKernels kAvx2BrakeKernels;
extern const BrakeKernels kAvx512BrakeKernels;

}  // namespace train_dynamics
