#pragma once

#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/lane_kernels.h"
#include "train_dynamics/vehicle/wagon_step.h"

/// The laws on the bytes and arrays of a train, over the scalar type T. Each file of this folder makes one
/// instance and is compiled for its own instruction set; it must use no function that another file could share
/// with it by name, so: packs and plain pointers only.
namespace train_dynamics {

template <class T>
void Step(const Wagon& wagon, const TrackParams& track, const VehicleLoads<T>& loads, double dt,
          WagonState<T>& state, WagonOutput<T>* output) {
  StepWagon(wagon, track, loads, dt, state, output);
}

template <class T>
void Step(const LtdVehicle& vehicle, const TrackParams& track, const VehicleLoads<T>& loads, double dt,
          LtdState<T>& state, LtdOutput<T>* output) {
  StepLtd(vehicle, track, loads, dt, state, output);
}

template <class T, class Vehicle>
[[gnu::flatten]] bool StepPacks(const Vehicle& vehicle, const TrackParams& track, double dt, int steps,
                                int packs, const VehicleArrays& arrays, std::byte* states,
                                std::byte* outputs) {
  using State = typename Vehicle::template State<T>;
  using Output = typename Vehicle::template Output<T>;
  MaskOf<T> sound = T(0.0) == T(0.0);
  for (int i = 0; i < packs; ++i) {
    const int first = i * kLanesOf<T>;
    State& pack = reinterpret_cast<State*>(states)[i];
    Output* output = outputs == nullptr ? nullptr : reinterpret_cast<Output*>(outputs) + i;
    VehicleLoads<T> loads{};
    loads.front_coupler_n = Load<T>(arrays.front_coupler_n + first);
    loads.rear_coupler_n = Load<T>(arrays.rear_coupler_n + first);
    loads.cylinder_pressure_pa = Load<T>(arrays.cylinder_pressure_pa + first);
    for (int step = 1; step < steps; ++step) {
      Step(vehicle, track, loads, dt, pack, static_cast<Output*>(nullptr));
    }
    Step(vehicle, track, loads, dt, pack, output);
    Store(CouplerHeadDisplacement(vehicle, pack), arrays.head_displacement_m + first);
    Store(CouplerHeadVelocity(vehicle, pack), arrays.head_velocity_mps + first);
    sound = sound & IsSound(pack);
  }
  return AllOf(sound);
}

template <class T, class Vehicle>
void RecordPack(const Vehicle& vehicle, const std::byte* state, const std::byte* output,
                const RecordArrays& record) {
  const auto& pack = *reinterpret_cast<const typename Vehicle::template State<T>*>(state);
  const auto& shown = *reinterpret_cast<const typename Vehicle::template Output<T>*>(output);
  const VehicleRecord<T> r = RecordOf(vehicle, pack, shown);
  Store(r.head_displacement_m, record.head_displacement_m);
  Store(r.head_velocity_mps, record.head_velocity_mps);
  Store(r.position_m, record.position_m);
  Store(r.speed_mps, record.speed_mps);
  Store(r.shoe_force_n, record.shoe_force_n);
  Store(r.wheel_force_n, record.wheel_force_n);
  Store(r.creepage, record.creepage);
}

template <class T>
constexpr LaneKernels KernelsOver(const char* instruction_set) {
  return {instruction_set,           kLanesOf<T>,           &StepPacks<T, Wagon>,
          &StepPacks<T, LtdVehicle>, &RecordPack<T, Wagon>, &RecordPack<T, LtdVehicle>};
}

extern const LaneKernels kScalarLaneKernels;
extern const LaneKernels kBaseLaneKernels;  ///< two lanes: what every x86-64 has
extern const LaneKernels kAvx2LaneKernels;
extern const LaneKernels kAvx512LaneKernels;

}  // namespace train_dynamics
