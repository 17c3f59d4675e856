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
[[gnu::flatten]] bool StepPack(const Vehicle& vehicle, const TrackParams& track, double dt, int steps,
                               const VehicleArrays& arrays, std::byte* state, std::byte* output) {
  using State = typename Vehicle::template State<T>;
  using Output = typename Vehicle::template Output<T>;
  auto& pack = *reinterpret_cast<State*>(state);
  VehicleLoads<T> loads{};
  loads.front_coupler_n = Load<T>(arrays.front_coupler_n);
  loads.rear_coupler_n = Load<T>(arrays.rear_coupler_n);
  loads.cylinder_pressure_pa = Load<T>(arrays.cylinder_pressure_pa);
  for (int step = 1; step < steps; ++step) {
    Step(vehicle, track, loads, dt, pack, static_cast<Output*>(nullptr));
  }
  Step(vehicle, track, loads, dt, pack, reinterpret_cast<Output*>(output));
  Store(CouplerHeadDisplacement(vehicle, pack), arrays.head_displacement_m);
  Store(CouplerHeadVelocity(vehicle, pack), arrays.head_velocity_mps);
  return AllOf(IsSound(pack));
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
void ConnectionForces(const Connection& type, double prediction_s, double time_s, int count,
                      const ConnectionArrays& at) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    const T rate = Load<T>(at.rate_mps + i);
    const T extension = Load<T>(at.extension_m + i) + prediction_s * rate;
    StickState<T> stick{Load<T>(at.stick_m + i), Load<T>(at.stick_n + i)};
    const GearForce<T> f = ConnectionForce(type, extension, rate, stick);
    Store(f.force, at.force_n + i);
    Store(f.elastic, at.elastic_n + i);
    Store(stick.q, at.stick_m + i);
    Store(stick.force, at.stick_n + i);
    const auto keep_extreme = [&](MaskOf<T> beyond, double* extreme_n, double* extreme_time_s) {
      Store(Select(beyond, f.force, Load<T>(extreme_n + i)), extreme_n + i);
      Store(Select(beyond, T(time_s), Load<T>(extreme_time_s + i)), extreme_time_s + i);
    };
    keep_extreme(f.force > Load<T>(at.tension_n + i), at.tension_n, at.tension_time_s);
    keep_extreme(f.force < Load<T>(at.compression_n + i), at.compression_n, at.compression_time_s);
  }
}

template <class T>
void CylinderPressures(const BrakePhases& phases, double time_s, int count, double* pressure_pa) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    Store(CylinderPressure<T>(phases, i, time_s), pressure_pa + i);
  }
}

template <class T>
constexpr LaneKernels KernelsOver(const char* instruction_set) {
  return {instruction_set,          kLanesOf<T>,           &StepPack<T, Wagon>,
          &StepPack<T, LtdVehicle>, &RecordPack<T, Wagon>, &RecordPack<T, LtdVehicle>,
          &ConnectionForces<T>,     &CylinderPressures<T>};
}

extern const LaneKernels kScalarLaneKernels;
extern const LaneKernels kBaseLaneKernels;  ///< two lanes: what every x86-64 has
extern const LaneKernels kAvx2LaneKernels;
extern const LaneKernels kAvx512LaneKernels;

}  // namespace train_dynamics
