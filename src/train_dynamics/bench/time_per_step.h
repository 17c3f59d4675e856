#pragma once

#include <benchmark/benchmark.h>

namespace train_dynamics::bench {

/// Shows the time per vehicle and step beside a benchmark whose iteration is one step of `vehicles` vehicles.
inline void ShowTimePerVehicleStep(benchmark::State& state, int vehicles) {
  state.counters["s_per_vehicle_step"] =
      benchmark::Counter(vehicles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace train_dynamics::bench
