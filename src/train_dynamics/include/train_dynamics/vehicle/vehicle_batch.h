#pragma once

#include <boost/align/aligned_allocator.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "train_dynamics/vehicle/lane_kernels.h"

namespace train_dynamics {

/// Vehicles of one type in packs of lanes. The last pack is filled up with copies of its first vehicle, which are never
/// read.
template <class Vehicle>
class VehicleBatch {
 public:
  using State = typename Vehicle::template State<double>;
  using Output = typename Vehicle::template Output<double>;

  static_assert(kIsRowOfNumbers<Vehicle::template State> && kIsRowOfNumbers<Vehicle::template Output>,
                "state and output of a vehicle are handled as rows of numbers");

  VehicleBatch(const Vehicle& vehicle, const LaneKernels& kernels, const std::vector<State>& states);

  int size() const { return size_; }
  int lanes() const { return kernels_.lanes; }
  const Vehicle& vehicle() const { return vehicle_; }

  /// Advances all vehicles by `steps` steps. @param loads, reply  of the first vehicle; those of the others follow
  /// @param with_output  keep what the last step shows
  /// @return whether all vehicles are sound
  bool Advance(const Track& track, double dt, int steps, const LoadPlaces& loads, const ReplyPlaces& reply,
               bool with_output);

  /// What every vehicle replies, and what a record holds of it, after an Advance with output.
  void Record(const ReplyPlaces& reply, const RecordPlaces& record) const;

  /// Numbers in the state of a vehicle.
  static constexpr int kNumbers = sizeof(State) / sizeof(double);

  State StateOf(int i) const;
  /// One number of it.
  double NumberOf(int i, int field) const;
  /// One number of OutputOf(i).
  double OutputNumberOf(int i, int field) const;
  /// Whether a wheelset of any vehicle slips by more than a share of its speed, that being at least `slowest_mps`.
  bool AnySlip(double share, double slowest_mps) const;
  /// What vehicle i showed of the last step with output; NaN before.
  Output OutputOf(int i) const;
  void SetState(int i, const State& state);
  /// Digest of the positions and velocities of every vehicle.
  void Digests(std::uint64_t* digest) const;

 private:
  using Bytes = std::vector<std::byte, boost::alignment::aligned_allocator<std::byte, 64>>;

  template <class Struct>
  Struct Unpack(const Bytes& packed, int i) const;
  template <class Struct>
  double Number(const Bytes& packed, int i, int field) const;
  template <class Struct>
  void Pack(const Struct& value, int i, Bytes& packed) const;

  Vehicle vehicle_;
  LaneKernels kernels_;
  LaneKernels::StepPacks<Vehicle> step_;
  LaneKernels::RecordPack<Vehicle> record_;
  int size_;
  int packs_;
  Bytes states_, outputs_;
};

using WagonBatch = VehicleBatch<Wagon>;
using LtdBatch = VehicleBatch<LtdVehicle>;

}  // namespace train_dynamics
