#include "train_dynamics/vehicle/vehicle_batch.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "kernels/lane_laws.h"
#include "train_dynamics/numeric/digest.h"

namespace train_dynamics {
namespace {

constexpr std::size_t kDouble = sizeof(double);

template <class Struct>
constexpr std::size_t Fields() {
  return sizeof(Struct) / kDouble;
}

LaneKernels::StepPacks<Wagon> StepOf(const LaneKernels& kernels, const Wagon&) { return kernels.step_wagons; }
LaneKernels::StepPacks<SixAxleVehicle> StepOf(const LaneKernels& kernels, const SixAxleVehicle&) {
  return kernels.step_six_axle;
}
LaneKernels::StepPacks<LtdVehicle> StepOf(const LaneKernels& kernels, const LtdVehicle&) {
  return kernels.step_ltd;
}

LaneKernels::RecordPack<Wagon> RecordOf(const LaneKernels& kernels, const Wagon&) {
  return kernels.record_wagons;
}
LaneKernels::RecordPack<SixAxleVehicle> RecordOf(const LaneKernels& kernels, const SixAxleVehicle&) {
  return kernels.record_six_axle;
}
LaneKernels::RecordPack<LtdVehicle> RecordOf(const LaneKernels& kernels, const LtdVehicle&) {
  return kernels.record_ltd;
}

/// The arrays of an exchange for a pack that is not full: its spare lanes get what the first lane gets.
class SpareLanes {
 public:
  SpareLanes(const VehicleArrays& at, int used) : at_(at), used_(used) {
    Fill(at.front_coupler_n, front_);
    Fill(at.rear_coupler_n, rear_);
    Fill(at.cylinder_pressure_pa, pressure_);
  }
  VehicleArrays arrays() {
    return {front_.data(), rear_.data(), pressure_.data(), displacement_.data(), velocity_.data()};
  }
  void GiveBack() const {
    std::copy_n(displacement_.begin(), used_, at_.head_displacement_m);
    std::copy_n(velocity_.begin(), used_, at_.head_velocity_mps);
  }

 private:
  using Pack = std::array<double, kMostLanes>;
  void Fill(const double* from, Pack& pack) const {
    pack.fill(from[0]);
    std::copy_n(from, used_, pack.begin());
  }
  const VehicleArrays at_;
  const int used_;
  Pack front_, rear_, pressure_, displacement_, velocity_;
};

/// The same for the arrays of a record.
class SpareRecord {
 public:
  RecordArrays arrays() {
    return {a_[0].data(), a_[1].data(), a_[2].data(), a_[3].data(), a_[4].data(), a_[5].data(), a_[6].data()};
  }
  void GiveBack(const RecordArrays& to, int used) const {
    double* const arrays[] = {to.head_displacement_m, to.head_velocity_mps, to.position_m, to.speed_mps,
                              to.shoe_force_n,        to.wheel_force_n,     to.creepage};
    for (std::size_t i = 0; i < a_.size(); ++i) std::copy_n(a_[i].begin(), used, arrays[i]);
  }

 private:
  std::array<std::array<double, kMostLanes>, 7> a_;
};

VehicleArrays Behind(const VehicleArrays& at, int vehicles) {
  return {at.front_coupler_n + vehicles, at.rear_coupler_n + vehicles, at.cylinder_pressure_pa + vehicles,
          at.head_displacement_m + vehicles, at.head_velocity_mps + vehicles};
}

RecordArrays Behind(const RecordArrays& at, int vehicles) {
  return {at.head_displacement_m + vehicles,
          at.head_velocity_mps + vehicles,
          at.position_m + vehicles,
          at.speed_mps + vehicles,
          at.shoe_force_n + vehicles,
          at.wheel_force_n + vehicles,
          at.creepage + vehicles};
}

}  // namespace

template <class Vehicle>
template <class Struct>
Struct VehicleBatch<Vehicle>::Unpack(const Bytes& packed, int i) const {
  const std::size_t lanes = kernels_.lanes, pack = i / lanes, lane = i % lanes;
  const std::byte* from = &packed[pack * lanes * sizeof(Struct) + lane * kDouble];
  Struct value;
  auto* to = reinterpret_cast<std::byte*>(&value);
  for (std::size_t field = 0; field < Fields<Struct>(); ++field) {
    std::memcpy(to + field * kDouble, from + field * lanes * kDouble, kDouble);
  }
  return value;
}

template <class Vehicle>
template <class Struct>
void VehicleBatch<Vehicle>::Pack(const Struct& value, int i, Bytes& packed) const {
  const std::size_t lanes = kernels_.lanes, pack = i / lanes, lane = i % lanes;
  std::byte* to = &packed[pack * lanes * sizeof(Struct) + lane * kDouble];
  const auto* from = reinterpret_cast<const std::byte*>(&value);
  for (std::size_t field = 0; field < Fields<Struct>(); ++field) {
    std::memcpy(to + field * lanes * kDouble, from + field * kDouble, kDouble);
  }
}

template <class Vehicle>
VehicleBatch<Vehicle>::VehicleBatch(const Vehicle& vehicle, const LaneKernels& kernels,
                                    const std::vector<State>& states)
    : vehicle_(vehicle),
      kernels_(kernels),
      step_(StepOf(kernels, vehicle)),
      record_(RecordOf(kernels, vehicle)),
      size_(static_cast<int>(states.size())),
      packs_((size_ + kernels.lanes - 1) / kernels.lanes) {
  const std::size_t places = static_cast<std::size_t>(packs_) * kernels.lanes;
  states_.resize(places * sizeof(State));
  outputs_.resize(places * sizeof(Output));
  for (int i = 0; i < size_; ++i) SetState(i, states[i]);
  const double not_computed = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t at = 0; at < outputs_.size(); at += kDouble) {
    std::memcpy(&outputs_[at], &not_computed, kDouble);
  }
}

template <class Vehicle>
typename VehicleBatch<Vehicle>::State VehicleBatch<Vehicle>::StateOf(int i) const {
  return Unpack<State>(states_, i);
}

template <class Vehicle>
typename VehicleBatch<Vehicle>::Output VehicleBatch<Vehicle>::OutputOf(int i) const {
  return Unpack<Output>(outputs_, i);
}

template <class Vehicle>
void VehicleBatch<Vehicle>::SetState(int i, const State& state) {
  Pack(state, i, states_);
  const bool is_first_of_last_pack = i == (packs_ - 1) * kernels_.lanes;
  if (!is_first_of_last_pack) return;
  for (int spare = size_; spare < packs_ * kernels_.lanes; ++spare) Pack(state, spare, states_);
}

template <class Vehicle>
bool VehicleBatch<Vehicle>::Advance(const TrackParams& track, double dt, int steps,
                                    const VehicleArrays& arrays, bool with_output) {
  const int lanes = kernels_.lanes, full = size_ / lanes;
  const auto step = [&](int packs, int from, const VehicleArrays& at) {
    std::byte* states = states_.data() + static_cast<std::size_t>(from) * lanes * sizeof(State);
    std::byte* outputs =
        with_output ? outputs_.data() + static_cast<std::size_t>(from) * lanes * sizeof(Output) : nullptr;
    return step_(vehicle_, track, dt, steps, packs, at, states, outputs);
  };
  bool sound = step(full, 0, arrays);
  if (full < packs_) {
    SpareLanes spare(Behind(arrays, full * lanes), size_ - full * lanes);
    sound &= step(1, full, spare.arrays());
    spare.GiveBack();
  }
  return sound;
}

template <class Vehicle>
void VehicleBatch<Vehicle>::Record(const RecordArrays& record) const {
  const int lanes = kernels_.lanes;
  for (int first = 0; first < size_; first += lanes) {
    const std::byte* state = &states_[first * sizeof(State)];
    const std::byte* output = &outputs_[first * sizeof(Output)];
    const RecordArrays at = Behind(record, first);
    const int used = std::min(lanes, size_ - first);
    if (used == lanes) {
      record_(vehicle_, state, output, at);
      continue;
    }
    SpareRecord spare;
    record_(vehicle_, state, output, spare.arrays());
    spare.GiveBack(at, used);
  }
}

template <class Vehicle>
void VehicleBatch<Vehicle>::Digests(std::uint64_t* digest) const {
  const int lanes = kernels_.lanes;
  for (int pack = 0; pack < packs_; ++pack) {
    // Field by field over the lanes: the lanes' chains of operations do not wait for each other.
    std::array<Digest, kMostLanes> of_lane{};
    const std::byte* state = &states_[static_cast<std::size_t>(pack) * lanes * sizeof(State)];
    for (const std::size_t field : Vehicle::kDigestedFields) {
      std::array<double, kMostLanes> values;
      std::memcpy(values.data(), state + field * lanes * kDouble, lanes * kDouble);
      for (int lane = 0; lane < lanes; ++lane) of_lane[lane].Add(values[lane]);
    }
    for (int lane = 0; lane < lanes && pack * lanes + lane < size_; ++lane) {
      digest[pack * lanes + lane] = of_lane[lane].value();
    }
  }
}

const std::vector<LaneKernels>& AllLaneKernels() {
  static const std::vector<LaneKernels> kernels = [] {
    std::vector<LaneKernels> usable;
#if defined(TRAIN_BRAKE_X86_KERNELS)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
      usable.push_back(kAvx512LaneKernels);
    }
    if (__builtin_cpu_supports("avx2")) usable.push_back(kAvx2LaneKernels);
#endif
    usable.push_back(kBaseLaneKernels);
    usable.push_back(kScalarLaneKernels);
    return usable;
  }();
  return kernels;
}

template class VehicleBatch<Wagon>;
template class VehicleBatch<SixAxleVehicle>;
template class VehicleBatch<LtdVehicle>;

}  // namespace train_dynamics
