#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/numeric/instruction_set.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// The arrays of an exchange from the place of one vehicle on, one number per vehicle.
struct VehicleArrays {
  const double* front_coupler_n;
  const double* rear_coupler_n;
  const double* cylinder_pressure_pa;
  double* head_displacement_m;  ///< of the coupler heads since the start
  double* head_velocity_mps;
};

/// The time step of vehicles, `lanes` of them side by side in the registers of one instruction set.
///
/// State and output of a pack of vehicles lie in memory as [field][lane] of doubles, the fields in the order
/// of the vehicle's State and Output; 64-byte aligned.
struct LaneKernels {
  /// Advances `packs` packs of vehicles of one type by `steps` steps of dt.
  /// @param outputs  what the last step shows; may be null
  /// @return whether all lanes are sound
  template <class Vehicle>
  using StepPacks = bool (*)(const Vehicle& vehicle, const TrackParams& track, double dt, int steps,
                             int packs, const VehicleArrays& arrays, std::byte* states, std::byte* outputs);

  /// What a record holds of a pack.
  template <class Vehicle>
  using RecordPack = void (*)(const Vehicle& vehicle, const std::byte* state, const std::byte* output,
                              const RecordArrays& record);

  const char* instruction_set;
  int lanes;
  StepPacks<Wagon> step_wagons;
  StepPacks<LtdVehicle> step_ltd;
  RecordPack<Wagon> record_wagons;
  RecordPack<LtdVehicle> record_ltd;
};

/// The kernels that were built and that this machine can run, fastest first. All give the same bits.
const std::vector<LaneKernels>& AllLaneKernels();

/// The fastest.
inline const LaneKernels& BestLaneKernels() { return AllLaneKernels().front(); }

}  // namespace train_dynamics
