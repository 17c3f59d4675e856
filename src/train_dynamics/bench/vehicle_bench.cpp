// Vehicles alone, 242 of one kind on one thread, by instruction set: NAME/INSTRUCTION_SET. "locked": wagons that slide
// with all wheels locked.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "moving_vehicles.h"
#include "time_per_step.h"

namespace train_dynamics::bench {
namespace {

template <class Vehicle>
void StepVehicles(benchmark::State& state, const LaneKernels& kernels, MovingVehicles<Vehicle>& moving) {
  const VehicleBatch<Vehicle> start(moving.vehicle, kernels, moving.states);
  VehicleBatch<Vehicle> batch = start;
  int step = 0;
  for (auto _ : state) {
    const bool sound = batch.Advance(moving.track, kTimeStep, 1, moving.loads(), moving.reply(), false);
    benchmark::DoNotOptimize(sound);
    if (++step % 1000 == 0) batch = start;  // the same motion, however long the measurement
  }
  ShowTimePerVehicleStep(state, kVehicles);
}

bool AllWheelsLocked(const MovingVehicles<Wagon>& moving) {
  return std::all_of(moving.states.begin(), moving.states.end(), [](const WagonState<double>& s) {
    return std::all_of(&s.velocity.pitch[kWheelset1], &s.velocity.pitch[kWheelset1] + kWheelsets,
                       [](double spin) { return spin == 0.0; });
  });
}

}  // namespace
}  // namespace train_dynamics::bench

int main(int argc, char** argv) {
  using namespace train_dynamics;
  using namespace train_dynamics::bench;
  MovingVehicles<Wagon> rolling = RollingWagons(), sliding = SlidingWagons();
  MovingVehicles<LtdVehicle> ltd = RollingLtdVehicles();
  if (!AllWheelsLocked(sliding)) {
    std::fputs("vehicle_bench: the sliding wagons' wheels are not locked\n", stderr);
    return 1;
  }

  for (const LaneKernels& kernels : AllLaneKernels()) {
    const std::string set = kernels.instruction_set;
    benchmark::RegisterBenchmark(("wagon/" + set).c_str(),
                                 [&](benchmark::State& state) { StepVehicles(state, kernels, rolling); });
    benchmark::RegisterBenchmark(("wagon_locked/" + set).c_str(),
                                 [&](benchmark::State& state) { StepVehicles(state, kernels, sliding); });
    benchmark::RegisterBenchmark(("ltd/" + set).c_str(),
                                 [&](benchmark::State& state) { StepVehicles(state, kernels, ltd); });
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
