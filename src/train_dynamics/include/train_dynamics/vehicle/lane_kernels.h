#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/brake/air_brake.h"
#include "train_dynamics/coupler/connection.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/vehicle_loads.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// Cylinder pressures by recurrence, one number per vehicle.
struct GapArrays {
  double *target_pa, *gap_pa, *decay;
};

/// The time step and the laws between vehicles, `lanes` of them side by side in the registers of one
/// instruction set.
///
/// State and output of a pack of vehicles lie in memory as [field][lane] of doubles, the fields in the order
/// of the vehicle's State and Output; 64-byte aligned.
struct LaneKernels {
  /// Advances `packs` packs of vehicles of one type by `steps` steps of dt.
  /// @param loads, reply  of the first vehicle; those of the others follow
  /// @param outputs       what the last step shows; may be null
  /// @return whether all lanes are sound
  template <class Vehicle>
  using StepPacks = bool (*)(const Vehicle& vehicle, const Track& track, double dt, int steps,
                             int packs, const LoadPlaces& loads, const ReplyPlaces& reply, std::byte* states,
                             std::byte* outputs);

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
  /// Forces of `count` connections of one type, a multiple of `lanes`.
  void (*connection_forces)(const Connection& type, double prediction_s, double time_s, int count,
                            const ConnectionArrays& arrays);
  /// Moves `count` connections, a multiple of `lanes`, to these extensions [m], and books the work of their
  /// friction.
  void (*connection_work)(int count, const double* extension_m, const ConnectionArrays& arrays);
  /// Pressures of `count` vehicles at a time, a multiple of `lanes`.
  void (*cylinder_pressures)(const BrakePhases& phases, double time_s, int count, double* pressure_pa);
  /// Gaps of `count` vehicles to their targets at a time, and by what factor they close in dt.
  void (*cylinder_gaps)(const BrakePhases& phases, double time_s, double dt_s, int count,
                        const GapArrays& arrays);
  /// Closes the gaps by `steps` times dt; the pressures then.
  void (*close_cylinder_gaps)(int steps, int count, const GapArrays& arrays, double* pressure_pa);
};

/// The kernels that were built and that this machine can run, fastest first. All give the same bits.
const std::vector<LaneKernels>& AllLaneKernels();

/// The fastest.
inline const LaneKernels& BestLaneKernels() { return AllLaneKernels().front(); }

/// Arrays that kernels step through have a multiple of this many numbers.
inline constexpr int kMostLanes = 8;

/// The next multiple of kMostLanes.
inline constexpr int PaddedToLanes(int count) { return (count + kMostLanes - 1) / kMostLanes * kMostLanes; }

}  // namespace train_dynamics
