#include "train_dynamics/vehicle/vehicle_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

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
LaneKernels::StepPacks<LtdVehicle> StepOf(const LaneKernels& kernels, const LtdVehicle&) { return kernels.step_ltd; }

LaneKernels::RecordPack<Wagon> RecordOf(const LaneKernels& kernels, const Wagon&) { return kernels.record_wagons; }
LaneKernels::RecordPack<SixAxleVehicle> RecordOf(const LaneKernels& kernels, const SixAxleVehicle&) {
  return kernels.record_six_axle;
}
LaneKernels::RecordPack<LtdVehicle> RecordOf(const LaneKernels& kernels, const LtdVehicle&) {
  return kernels.record_ltd;
}

// ---- places in the arrays of an exchange ----------------------------------------------------------------------

LoadPlaces Behind(LoadPlaces at, int vehicles) {
  at.front_coupler_n += vehicles;
  at.rear_coupler_n += vehicles;
  ForEachLoad(
      [vehicles](const LoadInfo&, const double*& place) {
        if (place != nullptr) place += vehicles;
      },
      at);
  if (at.wheelset_pressure_pa != nullptr) at.wheelset_pressure_pa += vehicles * kMostWheelsets;
  if (at.traction_share != nullptr) at.traction_share += vehicles * kMostWheelsets;
  return at;
}

template <class Function>
void ForEachPlace(const Function& function, ReplyPlaces& places) {
  ForEachReplyField(function, places);
}
template <class Function>
void ForEachPlace(const Function& function, RecordPlaces& places) {
  ForEachRecordField(function, places);
}

template <class Places>
Places Behind(Places at, int vehicles) {
  ForEachPlace([vehicles](const RecordInfo& field, double*& place) { place += vehicles * field.numbers; }, at);
  return at;
}

/// The loads of a pack that is not full: its spare lanes get what the first lane gets.
class SpareLoads {
 public:
  SpareLoads(const LoadPlaces& at, int used) {
    Fill(at.front_coupler_n, used, values_.front_coupler_n, places_.front_coupler_n);
    Fill(at.rear_coupler_n, used, values_.rear_coupler_n, places_.rear_coupler_n);
    ForEachLoad([used](const LoadInfo&, const double* from, Pack& values,
                       const double*& place) { Fill(from, used, values, place); },
                at, values_, places_);
    places_.wheelset_pressure_pa = at.wheelset_pressure_pa;  // those of whole packs
    places_.traction_share = at.traction_share;
  }
  const LoadPlaces& places() const { return places_; }

 private:
  using Pack = std::array<double, kMostLanes>;
  static void Fill(const double* from, int used, Pack& values, const double*& place) {
    if (from == nullptr) return;
    values.fill(from[0]);
    std::copy_n(from, used, values.begin());
    place = values.data();
  }
  VehicleLoads<Pack> values_;
  LoadPlaces places_;
};

/// Where the kernels write what a pack that is not full replies or records.
template <class Places, int numbers>
class Spare {
 public:
  Spare() {
    double* next = values_.data();
    ForEachPlace(
        [&next](const RecordInfo& field, double*& place) {
          place = next;
          next += kMostLanes * field.numbers;
        },
        places_);
  }
  const Places& places() const { return places_; }

  /// Copies what the first `used` vehicles of the pack have to their places.
  void GiveBack(Places to, int used) {
    const double* from = values_.data();
    ForEachPlace(
        [&from, used](const RecordInfo& field, double*& place) {
          std::copy_n(from, used * field.numbers, place);
          from += kMostLanes * field.numbers;
        },
        to);
  }

 private:
  std::array<double, static_cast<std::size_t>(kMostLanes* numbers)> values_;
  Places places_;
};
using SpareReply = Spare<ReplyPlaces, kReplyNumbers>;
using SpareRecord = Spare<RecordPlaces, kRecordNumbers>;

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
template <class Struct>
double VehicleBatch<Vehicle>::Number(const Bytes& packed, int i, int field) const {
  const std::size_t lanes = kernels_.lanes, pack = i / lanes, lane = i % lanes;
  double number;
  std::memcpy(&number, &packed[pack * lanes * sizeof(Struct) + (field * lanes + lane) * kDouble], kDouble);
  return number;
}

template <class Vehicle>
double VehicleBatch<Vehicle>::NumberOf(int i, int field) const {
  return Number<State>(states_, i, field);
}

template <class Vehicle>
double VehicleBatch<Vehicle>::OutputNumberOf(int i, int field) const {
  return Number<Output>(outputs_, i, field);
}

template <class Vehicle>
bool VehicleBatch<Vehicle>::AnySlip(double share, double slowest_mps) const {
  if constexpr (std::is_same_v<Vehicle, LtdVehicle>) {
    return false;
  } else {
    const int lanes = kernels_.lanes;
    const double radius_m = vehicle_.rolling.radius_m;
    std::int64_t any = 0;  // as wide as a double: compilers make vector code of the loop
    for (int pack = 0; pack < packs_; ++pack) {
      const auto* state =
          reinterpret_cast<const double*>(&states_[static_cast<std::size_t>(pack) * lanes * sizeof(State)]);
      const double* speed = state + Vehicle::kFirstSpeed * lanes;  // [wheelset][lane]
      const double* spin = state + Vehicle::kFirstSpin * lanes;
      for (int i = 0; i < Vehicle::kWheelsets * lanes; ++i) {
        const double slip = std::abs(speed[i] - radius_m * spin[i]);
        any |= slip > share * std::max(std::abs(speed[i]), slowest_mps);
      }
    }
    return any != 0;
  }
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
bool VehicleBatch<Vehicle>::Advance(const Track& track, double dt, int steps, const LoadPlaces& loads,
                                    const ReplyPlaces& reply, bool with_output) {
  const int lanes = kernels_.lanes, full = size_ / lanes;
  const auto step = [&](int packs, int from, const LoadPlaces& loads_there, const ReplyPlaces& reply_there) {
    std::byte* states = states_.data() + static_cast<std::size_t>(from) * lanes * sizeof(State);
    std::byte* outputs =
        with_output ? outputs_.data() + static_cast<std::size_t>(from) * lanes * sizeof(Output) : nullptr;
    return step_(vehicle_, track, dt, steps, packs, loads_there, reply_there, states, outputs);
  };
  bool sound = step(full, 0, loads, reply);
  if (full < packs_) {
    const int first = full * lanes, used = size_ - first;
    const SpareLoads spare_loads(Behind(loads, first), used);
    SpareReply spare_reply;
    sound &= step(1, full, spare_loads.places(), spare_reply.places());
    spare_reply.GiveBack(Behind(reply, first), used);
  }
  return sound;
}

template <class Vehicle>
void VehicleBatch<Vehicle>::Record(const ReplyPlaces& reply, const RecordPlaces& record) const {
  const int lanes = kernels_.lanes;
  for (int first = 0; first < size_; first += lanes) {
    const std::byte* state = &states_[first * sizeof(State)];
    const std::byte* output = &outputs_[first * sizeof(Output)];
    const int used = std::min(lanes, size_ - first);
    if (used == lanes) {
      record_(vehicle_, state, output, Behind(reply, first), Behind(record, first));
      continue;
    }
    SpareReply spare_reply;
    SpareRecord spare_record;
    record_(vehicle_, state, output, spare_reply.places(), spare_record.places());
    spare_reply.GiveBack(Behind(reply, first), used);
    spare_record.GiveBack(Behind(record, first), used);
  }
}

namespace {

/// Digests of the states in a pack, field by field over the lanes: their chains of operations do not wait for each
/// other, and with a fixed number of lanes they stay in registers.
template <int kLanes>
std::array<Digest, kMostLanes> DigestsOfPack(const std::byte* pack, const int* field, std::size_t fields) {
  std::array<Digest, kLanes> of_lane{};
  for (std::size_t i = 0; i < fields; ++i) {
    std::array<double, kLanes> values;
    std::memcpy(values.data(), pack + static_cast<std::size_t>(field[i]) * sizeof values, sizeof values);
    for (int lane = 0; lane < kLanes; ++lane) of_lane[lane].Add(values[lane]);
  }
  std::array<Digest, kMostLanes> all{};
  std::copy(of_lane.begin(), of_lane.end(), all.begin());
  return all;
}

}  // namespace

template <class Vehicle>
void VehicleBatch<Vehicle>::Digests(std::uint64_t* digest) const {
  const int lanes = kernels_.lanes;
  const auto of_pack = lanes == 8   ? &DigestsOfPack<8>
                       : lanes == 4 ? &DigestsOfPack<4>
                       : lanes == 2 ? &DigestsOfPack<2>
                                    : &DigestsOfPack<1>;
  static_assert(kMostLanes == 8, "each number of lanes has its function");
  for (int pack = 0; pack < packs_; ++pack) {
    const std::byte* state = &states_[static_cast<std::size_t>(pack) * lanes * sizeof(State)];
    const std::array<Digest, kMostLanes> of_lane =
        of_pack(state, Vehicle::kDigestedFields.data(), Vehicle::kDigestedFields.size());
    for (int lane = 0; lane < lanes && pack * lanes + lane < size_; ++lane) {
      digest[pack * lanes + lane] = of_lane[lane].value();
    }
  }
}

const std::vector<LaneKernels>& AllLaneKernels() {
#if defined(TRAIN_BRAKE_X86_KERNELS)
  static const std::vector<LaneKernels> kernels =
      RunnableKernels(&kAvx512LaneKernels, &kAvx2LaneKernels, kBaseLaneKernels, kScalarLaneKernels);
#else
  static const std::vector<LaneKernels> kernels =
      RunnableKernels<LaneKernels>(nullptr, nullptr, kBaseLaneKernels, kScalarLaneKernels);
#endif
  return kernels;
}

const LaneKernels& BestLaneKernels(int vehicles) {
  const std::vector<LaneKernels>& all = AllLaneKernels();
  const int lanes = std::min(vehicles, all.front().lanes);
  return *std::find_if(all.rbegin(), all.rend(), [&](const auto& kernels) { return kernels.lanes >= lanes; });
}

template class VehicleBatch<Wagon>;
template class VehicleBatch<SixAxleVehicle>;
template class VehicleBatch<LtdVehicle>;

}  // namespace train_dynamics
