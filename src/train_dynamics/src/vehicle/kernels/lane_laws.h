#pragma once

#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/lane_kernels.h"
#include "train_dynamics/vehicle/wagon_step.h"

/// The laws on the bytes and arrays of a train, over the scalar type T. Each file of this folder makes one
/// instance and is compiled for its own instruction set; it must use no function that another file could share
/// with it by name, so: packs and plain pointers only.
namespace train_dynamics {

template <class T, int kPerBogie>
void Step(const BogieVehicle<kPerBogie>& wagon, const TrackParams& track, const VehicleLoads<T>& loads,
          double dt, WagonState<T, kPerBogie>& state, WagonOutput<T, kPerBogie>* output) {
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
[[gnu::flatten]] void ConnectionForces(const Connection& type, double prediction_s, double time_s, int count,
                                       const ConnectionArrays& at) {
  const auto for_each_pack = [&](const auto& law) {
    for (int i = 0; i < count; i += kLanesOf<T>) {
      const T rate = Load<T>(at.rate_mps + i);
      const GearForce<T> f = law(i, Load<T>(at.extension_m + i) + prediction_s * rate, rate);
      Store(f.force, at.force_n + i);
      Store(f.elastic, at.elastic_n + i);
      const auto keep_extreme = [&](MaskOf<T> beyond, double* extreme_n, double* extreme_time_s) {
        if (!AnyOf(beyond)) return;  // most of the time
        Store(Select(beyond, f.force, Load<T>(extreme_n + i)), extreme_n + i);
        Store(Select(beyond, T(time_s), Load<T>(extreme_time_s + i)), extreme_time_s + i);
      };
      keep_extreme(f.force > Load<T>(at.tension_n + i), at.tension_n, at.tension_time_s);
      keep_extreme(f.force < Load<T>(at.compression_n + i), at.compression_n, at.compression_time_s);
    }
  };
  if (type.kind == ConnectionKind::kDrawBar) {
    for_each_pack([&](int /*i*/, T q, T q_rate) { return DrawBarForce(type.bar, q, q_rate); });
  } else if (type.gear.params.friction == DraftGearFriction::kSmooth) {
    const DraftGear gear = type.gear;  // a copy that no store can change: its numbers stay in registers
    for_each_pack([&](int /*i*/, T q, T q_rate) { return SmoothGearForce(gear, q, q_rate); });
  } else {
    for_each_pack([&](int i, T q, T q_rate) {
      StickState<T> stick{Load<T>(at.stick_m + i), Load<T>(at.stick_n + i)};
      const GearForce<T> f = StickSpringGearForce(type.gear, q, q_rate, stick);
      Store(stick.q, at.stick_m + i);
      Store(stick.force, at.stick_n + i);
      return f;
    });
  }
}

template <class T>
void ConnectionWork(int count, const double* extension_m, const ConnectionArrays& at) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    const T end = Load<T>(extension_m + i);
    const T friction = Load<T>(at.force_n + i) - Load<T>(at.elastic_n + i);
    Store(Load<T>(at.dissipated_j + i) + friction * (end - Load<T>(at.extension_m + i)), at.dissipated_j + i);
    Store(end, at.extension_m + i);
  }
}

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
void CloseCylinderGaps(int steps, int count, const GapArrays& at, double* pressure_pa) {
  for (int i = 0; i < count; i += kLanesOf<T>) {
    T gap = Load<T>(at.gap_pa + i);
    for (int step = 0; step < steps; ++step) gap = gap * Load<T>(at.decay + i);
    Store(gap, at.gap_pa + i);
    Store(Load<T>(at.target_pa + i) + gap, pressure_pa + i);
  }
}

template <class T>
constexpr LaneKernels KernelsOver(const char* instruction_set) {
  return {instruction_set,
          kLanesOf<T>,
          &StepPacks<T, Wagon>,
          &StepPacks<T, SixAxleVehicle>,
          &StepPacks<T, LtdVehicle>,
          &RecordPack<T, Wagon>,
          &RecordPack<T, SixAxleVehicle>,
          &RecordPack<T, LtdVehicle>,
          &ConnectionForces<T>,
          &ConnectionWork<T>,
          &CylinderPressures<T>,
          &CylinderGaps<T>,
          &CloseCylinderGaps<T>};
}

extern const LaneKernels kScalarLaneKernels;
extern const LaneKernels kBaseLaneKernels;  ///< two lanes: what every x86-64 has
extern const LaneKernels kAvx2LaneKernels;
extern const LaneKernels kAvx512LaneKernels;

}  // namespace train_dynamics
