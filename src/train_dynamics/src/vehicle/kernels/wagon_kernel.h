#pragma once

#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/wagon_batch.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {

/// StepWagon on the bytes of a batch, over the scalar type T. Each file of this folder makes one instance and
/// is compiled for its own instruction set; it must use no function that another file could share with it by
/// name, so: packs only.
template <class T>
void StepPack(const Wagon& wagon, const TrackParams& track, double dt, int steps, const std::byte* loads,
              std::byte* state, std::byte* heads, std::byte* output) {
  const auto& pack_loads = *reinterpret_cast<const VehicleLoads<T>*>(loads);
  auto& pack_state = *reinterpret_cast<WagonState<T>*>(state);
  auto* pack_output = reinterpret_cast<WagonOutput<T>*>(output);
  for (int step = 1; step < steps; ++step) {
    StepWagon(wagon, track, pack_loads, dt, pack_state, static_cast<WagonOutput<T>*>(nullptr));
  }
  StepWagon(wagon, track, pack_loads, dt, pack_state, pack_output);
  auto& pack_heads = *reinterpret_cast<WagonHeads<T>*>(heads);
  pack_heads.displacement_m = CouplerHead(wagon, pack_state.position);
  pack_heads.velocity_mps = CouplerHead(wagon, pack_state.velocity);
  pack_heads.sound = Select(IsSound(pack_state), T(1.0), T(0.0));
}

extern const WagonKernel kScalarWagonKernel;
extern const WagonKernel kBaseWagonKernel;  ///< two lanes: what every x86-64 has
extern const WagonKernel kAvx2WagonKernel;
extern const WagonKernel kAvx512WagonKernel;

}  // namespace train_dynamics
