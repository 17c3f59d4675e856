#pragma once

#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/lane_kernels.h"
#include "train_dynamics/vehicle/wagon_step.h"

/// The laws on the bytes and arrays of a train, over the scalar type T. Each file of this folder makes one
/// instance and is compiled for its own instruction set; it must use no function that another file could share
/// with it by name, so: packs and plain pointers only.
namespace train_dynamics {

template <bool kAll, bool kReacts, class T, int kPerBogie>
void Step(const BogieVehicle<kPerBogie>& wagon, const Track& track, const OneSurface& surface,
          const VehicleLoads<T>& loads, double dt, WagonState<T, kPerBogie>& state, WagonOutput<T, kPerBogie>* output) {
  StepWagonWith<kAll, kReacts>(wagon, track, surface, loads, dt, state, output);
}

template <bool kAll, bool kReacts, class T>
void Step(const LtdVehicle& vehicle, const Track& track, const OneSurface& /*surface*/, const VehicleLoads<T>& loads,
          double dt, LtdState<T>& state, LtdOutput<T>* output) {
  StepLtdWith<kAll>(vehicle, track, loads, dt, state, output);
}

template <class T, class Vehicle>
VehicleReply<T> ReplyOf(const Vehicle& vehicle, const typename Vehicle::template State<T>& state) {
  VehicleReply<T> reply;
  reply.head_displacement_m = CouplerHeadDisplacement(vehicle, state);
  reply.head_velocity_mps = CouplerHeadVelocity(vehicle, state);
  return reply;
}

/// Writes a quantity of a pack of vehicles to the places from its first vehicle on.
template <class T>
void StoreNumbers(const T& value, double* place) {
  Store(value, place);
}
template <class T, std::size_t n>
void StoreNumbers(const std::array<T, n>& values, double* place) {
  for (std::size_t i = 0; i < n; ++i) {
    double lanes[kLanesOf<T>];
    Store(values[i], lanes);
    for (int lane = 0; lane < kLanesOf<T>; ++lane) place[lane * n + i] = lanes[lane];
  }
}

/// Whether a load that few trains have is given.
template <class T>
bool HasRareLoads(const LoadPlaces& places) {
  bool has = places.wheelset_pressure_pa != nullptr || places.traction_share != nullptr;
  ForEachLoad(
      [&has](const LoadInfo& load, const double* place) { has |= load.given == Given::kWhereUsed && place != nullptr; },
      places);
  return has;
}

/// Loads of a pack from the place of its first vehicle on. What acts on no vehicle of the train is zero.
/// @tparam with_rare  false: those that few trains have are zero where it is compiled, so that their terms cost nothing
template <class T, bool with_rare>
VehicleLoads<T> LoadsAt(const LoadPlaces& places, int first) {
  VehicleLoads<T> loads{};
  loads.front_coupler_n = Load<T>(places.front_coupler_n + first);
  loads.rear_coupler_n = Load<T>(places.rear_coupler_n + first);
  ForEachLoad(
      [first](const LoadInfo& load, const double* place, T& value) {
        if (load.given == Given::kAlways || (with_rare && place != nullptr)) value = Load<T>(place + first);
      },
      places, loads);
  return loads;
}

/// Packs of a batch, [begin, end).
struct Packs {
  int begin, end;
};

/// @tparam kAll  with the loads that few trains have, and with what a plain vehicle or a plain track does not have
/// @tparam kReacts  see StepWagonWith
/// @param surface  see StepWagonWith
template <class T, bool kAll, bool kReacts, class Vehicle>
TRAIN_DYNAMICS_FLATTEN bool StepPacksUnder(const Vehicle& vehicle, const Track& track, const OneSurface& surface,
                                           double dt, int steps, Packs packs, const LoadPlaces& load_places,
                                           const ReplyPlaces& reply_places, std::byte* states, std::byte* outputs) {
  using State = typename Vehicle::template State<T>;
  using Output = typename Vehicle::template Output<T>;
  static_assert(sizeof(State) == kLanesOf<T> * sizeof(typename Vehicle::template State<double>) &&
                    sizeof(Output) == kLanesOf<T> * sizeof(typename Vehicle::template Output<double>),
                "a pack lies in memory as [field][lane]");
  MaskOf<T> sound = T(0.0) == T(0.0);
  for (int i = packs.begin; i < packs.end; ++i) {
    const int first = i * kLanesOf<T>;
    State& pack = reinterpret_cast<State*>(states)[i];
    Output* output = outputs == nullptr ? nullptr : reinterpret_cast<Output*>(outputs) + i;
    VehicleLoads<T> loads = LoadsAt<T, kAll>(load_places, first);
    std::array<T, kMostWheelsets> pressure, traction_share;
    const auto take = [first](const double* places, std::array<T, kMostWheelsets>& values,
                              const std::array<T, kMostWheelsets>*& given) {
      if (places == nullptr) return;
      const double* at = places + first * kMostWheelsets;
      for (int j = 0; j < kMostWheelsets; ++j) values[j] = Load<T>(at + j * kLanesOf<T>);
      given = &values;
    };
    if (kAll) {
      take(load_places.wheelset_pressure_pa, pressure, loads.wheelset_pressure_pa);
      take(load_places.traction_share, traction_share, loads.traction_share);
    }
    for (int step = 1; step < steps; ++step) {
      Step<kAll, kReacts>(vehicle, track, surface, loads, dt, pack, static_cast<Output*>(nullptr));
    }
    Step<kAll, kReacts>(vehicle, track, surface, loads, dt, pack, output);
    const VehicleReply<T> reply = ReplyOf<T>(vehicle, pack);
    ForEachReplyField([first](const RecordInfo& field, const auto& value,
                              double* place) { StoreNumbers(value, place + first * field.numbers); },
                      reply, reply_places);
    sound = sound & IsSound(vehicle, track, pack);
  }
  return AllOf(sound);
}

/// The same, but the compiler knows that no store changes vehicle or track: the constants of an LTD vehicle stay in
/// registers. A wagon has too many of them, which would displace its state.
template <class T, bool kAll>
TRAIN_DYNAMICS_FLATTEN bool StepLtdPacks(const LtdVehicle& __restrict vehicle, const Track& __restrict track, double dt,
                                         int steps, Packs packs, const LoadPlaces& loads, const ReplyPlaces& reply,
                                         std::byte* states, std::byte* outputs) {
  return StepPacksUnder<T, kAll, kAll>(vehicle, track, {}, dt, steps, packs, loads, reply, states, outputs);
}

/// Plain vehicles on a track with dips or patches: pack by pack and step by step, a pack on one surface and no dip
/// takes the step without look-ups.
template <class T, int kPerBogie>
bool StepPacksOnAnyTrack(const BogieVehicle<kPerBogie>& vehicle, const Track& track, double dt, int steps, int packs,
                         const LoadPlaces& loads, const ReplyPlaces& reply, std::byte* states, std::byte* outputs) {
  using Vehicle = BogieVehicle<kPerBogie>;
  const auto on_one_surface =
      Reacts(vehicle) ? &StepPacksUnder<T, false, true, Vehicle> : &StepPacksUnder<T, false, false, Vehicle>;
  bool sound = true;
  for (int i = 0; i < packs; ++i) {
    const auto& pack = reinterpret_cast<const WagonState<T, kPerBogie>*>(states)[i];
    for (int step = 1; step <= steps; ++step) {
      OneSurface surface;
      const auto advance =
          FindOneSurface(vehicle, track, dt, pack, surface) ? on_one_surface : &StepPacksUnder<T, true, true, Vehicle>;
      sound &=
          advance(vehicle, track, surface, dt, 1, {i, i + 1}, loads, reply, states, step == steps ? outputs : nullptr);
    }
  }
  return sound;
}

template <class T>
bool StepPacks(const LtdVehicle& vehicle, const Track& track, double dt, int steps, int packs, const LoadPlaces& loads,
               const ReplyPlaces& reply, std::byte* states, std::byte* outputs) {
  const bool all = HasRareLoads<T>(loads) || !IsPlain(vehicle, track);
  const auto step = all ? &StepLtdPacks<T, true> : &StepLtdPacks<T, false>;
  return step(vehicle, track, dt, steps, {0, packs}, loads, reply, states, outputs);
}

template <class T, int kPerBogie>
bool StepPacks(const BogieVehicle<kPerBogie>& vehicle, const Track& track, double dt, int steps, int packs,
               const LoadPlaces& loads, const ReplyPlaces& reply, std::byte* states, std::byte* outputs) {
  using Vehicle = BogieVehicle<kPerBogie>;
  const bool all = HasRareLoads<T>(loads) || !vehicle.IsPlain();
  if (!all && !track.IsPlain())
    return StepPacksOnAnyTrack<T>(vehicle, track, dt, steps, packs, loads, reply, states, outputs);
  const auto step = all               ? &StepPacksUnder<T, true, true, Vehicle>
                    : Reacts(vehicle) ? &StepPacksUnder<T, false, true, Vehicle>
                                      : &StepPacksUnder<T, false, false, Vehicle>;
  return step(vehicle, track, OwnSurface<T>(vehicle.params.wheel_rail.adhesion), dt, steps, {0, packs}, loads, reply,
              states, outputs);
}

template <class T, class Vehicle>
void RecordPack(const Vehicle& vehicle, const std::byte* state, const std::byte* output,
                const ReplyPlaces& reply_places, const RecordPlaces& record_places) {
  const auto& pack = *reinterpret_cast<const typename Vehicle::template State<T>*>(state);
  const auto& shown = *reinterpret_cast<const typename Vehicle::template Output<T>*>(output);
  const VehicleReply<T> reply = ReplyOf<T>(vehicle, pack);
  const VehicleRecord<T> record = RecordOf(vehicle, pack, shown);
  const auto store = [](const RecordInfo& /*field*/, const auto& value, double* place) { StoreNumbers(value, place); };
  ForEachReplyField(store, reply, reply_places);
  ForEachRecordField(store, record, record_places);
}

template <class T>
constexpr LaneKernels KernelsOver(const char* instruction_set) {
  LaneKernels kernels{};
  kernels.instruction_set = instruction_set;
  kernels.lanes = kLanesOf<T>;
  kernels.step_wagons = &StepPacks<T, 2>;
  kernels.step_six_axle = &StepPacks<T, 3>;
  kernels.step_ltd = &StepPacks<T>;
  kernels.record_wagons = &RecordPack<T, Wagon>;
  kernels.record_six_axle = &RecordPack<T, SixAxleVehicle>;
  kernels.record_ltd = &RecordPack<T, LtdVehicle>;
  return kernels;
}

extern const LaneKernels kScalarLaneKernels;
extern const LaneKernels kBaseLaneKernels;  ///< two lanes: what every x86-64 has
extern const LaneKernels kAvx2LaneKernels;
extern const LaneKernels kAvx512LaneKernels;

}  // namespace train_dynamics
