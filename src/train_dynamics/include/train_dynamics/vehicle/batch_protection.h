#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/slide_protection/slide_protection.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics {

/// Wheel-slide protection of the vehicles of a batch: between the supply that the train's brake gives each vehicle and
/// the shoes of its wheelsets. Runs vehicle by vehicle, before each step.
template <class Vehicle>
class BatchProtection {
 public:
  static constexpr int kWheelsets = Vehicle::kWheelsets;
  using State = ProtectionState<kWheelsets>;
  /// Numbers in the state of a vehicle.
  static constexpr int kNumbers = sizeof(State) / sizeof(double);

  BatchProtection(const SlideProtectionParams& params, double dt, const VehicleBatch<Vehicle>& batch);

  /// Samples and moves valves and cylinders on by the step that comes.
  /// @param step       counted from the start of the run
  /// @param supply_pa  of the first vehicle; those of the others follow
  /// @return the pressures over that step, as LoadPlaces takes them
  const double* Step(long step, const VehicleBatch<Vehicle>& batch, const double* supply_pa);

  const State& StateOf(int i) const { return states_[i]; }
  void SetState(int i, const State& state) { states_[i] = state; }

 private:
  SlideProtection protection_;
  int lanes_;
  std::vector<State> states_;
  std::vector<double> pressure_pa_;
};

}  // namespace train_dynamics
