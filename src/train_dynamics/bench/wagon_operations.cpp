// Counts the operations and the bytes of one time step of one vehicle; prints them as JSON. Exact and the same on every
// machine.
#include <cstdio>
#include <cstring>
#include <string>

#include "counted.h"
#include "moving_vehicles.h"
#include "step_in_parts.h"

namespace train_dynamics::bench {
namespace {

/// The struct over doubles as the same over Counted.
template <class To, class From>
To Copy(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}

template <class Action>
OperationCounts CountsOf(const Action& action) {
  g_counts = {};
  action();
  return g_counts;
}

void Print(const std::string& name, const OperationCounts& c, const char* end) {
  std::printf(
      "    \"%s\": {\"add\": %ld, \"multiply\": %ld, \"divide\": %ld, \"square_root\": %ld, \"compare\": "
      "%ld, "
      "\"select\": %ld}%s\n",
      name.c_str(), c.add, c.multiply, c.divide, c.square_root, c.compare, c.select, end);
}

void PrintWagon(const char* motion, const MovingVehicles<Wagon>& moving) {
  VehicleLoads<Counted> loads;
  loads.cylinder_pressure_pa = Counted(3.5e5);
  StepInParts<Counted> step(moving.vehicle, moving.track, loads, kTimeStep,
                            Copy<WagonState<Counted>>(moving.states[0]));
  std::printf("  \"%s\": {\n", motion);
  for (const StepPart<Counted>& part : kStepParts<Counted>) {
    Print(part.name, CountsOf([&] { (step.*part.run)(); }), ",");
  }
  Print("whole_step", CountsOf([&] { step.WholeStep(); }), "");
  std::printf("  },\n");
}

void PrintLtd() {
  const MovingVehicles<LtdVehicle> moving = RollingLtdVehicles();
  VehicleLoads<Counted> loads;
  loads.cylinder_pressure_pa = Counted(3.5e5);
  auto state = Copy<LtdState<Counted>>(moving.states[0]);
  LtdOutput<Counted>* const no_output = nullptr;
  const OperationCounts counts =
      CountsOf([&] { StepLtd(moving.vehicle, moving.track, loads, kTimeStep, state, no_output); });
  std::printf("  \"ltd\": {\n");
  Print("whole_step", counts, "");
  std::printf("  },\n");
}

/// What a step reads and writes: state, two coupler forces, pressure; coupler head's displacement and velocity.
template <class State>
int BytesPerStep() {
  return static_cast<int>(2 * sizeof(State) + 5 * sizeof(double));
}

}  // namespace
}  // namespace train_dynamics::bench

int main() {
  using namespace train_dynamics;
  using namespace train_dynamics::bench;
  std::printf("{\n");
  PrintWagon("rolling", RollingWagons());
  PrintWagon("sliding", SlidingWagons());
  PrintLtd();
  std::printf("  \"bytes_per_step\": {\"wagon\": %d, \"ltd\": %d}\n}\n", BytesPerStep<WagonState<double>>(),
              BytesPerStep<LtdState<double>>());
  return 0;
}
