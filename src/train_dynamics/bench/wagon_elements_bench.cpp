// The parts of the wagon's time step, each by itself over packs of lanes: rolling/PART, sliding/PART, and the whole
// step in the same setting. One iteration is four packs.
//
// Compiled for the machine that builds it: its packs are as wide as the widest kernel's of train_dynamics. A part by
// itself reads its input from memory and writes its result there, of which the whole step keeps a share in registers:
// the parts may add up to more than the whole.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "moving_vehicles.h"
#include "step_in_parts.h"
#include "time_per_step.h"
#include "train_dynamics/numeric/lanes.h"

namespace train_dynamics::bench {
namespace {

using Pack = Lanes<kNativeLanes>;
constexpr int kPacks = 4;  // so few that they stay in the nearest cache

/// Wagons first ... first + lanes - 1, side by side.
WagonState<Pack> SideBySide(const std::vector<WagonState<double>>& states, int first) {
  constexpr int kFields = sizeof(WagonState<double>) / sizeof(double);
  WagonState<Pack> pack;
  auto* to = reinterpret_cast<double*>(&pack);
  for (int field = 0; field < kFields; ++field) {
    for (int lane = 0; lane < kNativeLanes; ++lane) {
      *to++ = reinterpret_cast<const double*>(&states[first + lane])[field];
    }
  }
  return pack;
}

std::vector<StepInParts<Pack>> Packs(const MovingVehicles<Wagon>& moving) {
  std::vector<StepInParts<Pack>> packs;
  for (int i = 0; i < kPacks; ++i) {
    VehicleLoads<Pack> loads;
    loads.cylinder_pressure_pa = Pack(3.5e5);
    packs.emplace_back(moving.vehicle, moving.track, loads, kTimeStep, SideBySide(moving.states, i * kNativeLanes));
  }
  return packs;
}

void Run(benchmark::State& state, const MovingVehicles<Wagon>& moving, void (StepInParts<Pack>::*part)()) {
  const std::vector<StepInParts<Pack>> start = Packs(moving);
  std::vector<StepInParts<Pack>> packs = start;
  int step = 0;
  for (auto _ : state) {
    for (StepInParts<Pack>& pack : packs) (pack.*part)();
    benchmark::ClobberMemory();
    if (++step % 1000 == 0) packs = start;
  }
  ShowTimePerVehicleStep(state, kPacks * kNativeLanes);
}

}  // namespace
}  // namespace train_dynamics::bench

int main(int argc, char** argv) {
  using namespace train_dynamics;
  using namespace train_dynamics::bench;
  const MovingVehicles<Wagon> rolling = RollingWagons(), sliding = SlidingWagons();
  for (const auto& [motion, moving] : {std::pair{"rolling", &rolling}, std::pair{"sliding", &sliding}}) {
    const auto add = [&, of = moving](const std::string& name, void (StepInParts<Pack>::*part)()) {
      benchmark::RegisterBenchmark((motion + ("/" + name)).c_str(),
                                   [of, part](benchmark::State& state) { Run(state, *of, part); });
    };
    for (const StepPart<Pack>& part : kStepParts<Pack>) add(part.name, part.run);
    add("whole_step", &StepInParts<Pack>::WholeStep);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
