#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/numeric/instruction_set.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/vehicle_loads.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// The time step of vehicles, `lanes` of them side by side in the registers of one instruction set.
///
/// State and output of a pack of vehicles lie in memory as [field][lane] of doubles, the fields in the order
/// of the vehicle's State and Output; 64-byte aligned.
struct LaneKernels {
  /// Advances `packs` packs of vehicles of one type by `steps` steps of dt.
  /// @param loads, reply  of the first vehicle; those of the others follow
  /// @param outputs       what the last step shows; may be null
  /// @return whether all lanes are sound
  template <class Vehicle>
  using StepPacks = bool (*)(const Vehicle& vehicle, const Track& track, double dt, int steps, int packs,
                             const LoadPlaces& loads, const ReplyPlaces& reply, std::byte* states, std::byte* outputs);

  /// What a pack replies, and what a record holds of it.
  template <class Vehicle>
  using RecordPack = void (*)(const Vehicle& vehicle, const std::byte* state, const std::byte* output,
                              const ReplyPlaces& reply, const RecordPlaces& record);

  const char* instruction_set;
  int lanes;
  StepPacks<Wagon> step_wagons;
  StepPacks<SixAxleVehicle> step_six_axle;
  StepPacks<LtdVehicle> step_ltd;
  RecordPack<Wagon> record_wagons;
  RecordPack<SixAxleVehicle> record_six_axle;
  RecordPack<LtdVehicle> record_ltd;
};

/// The kernels that were built and that this machine can run, fastest first. All give the same bits.
const std::vector<LaneKernels>& AllLaneKernels();

/// The fastest for that many vehicles of one type: those of the widest lanes, but no wider than the vehicles fill. A
/// process with one vehicle would else compute, and hold in its cache, lanes that are never read.
const LaneKernels& BestLaneKernels(int vehicles);

}  // namespace train_dynamics
