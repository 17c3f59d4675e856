#pragma once

#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics::bench {

inline constexpr double kTimeStep = 1e-3;  // [s]
inline constexpr int kVehicles = 242;

inline config::LoadedScenario Emergency(const std::vector<std::string>& overrides) {
  return config::LoadScenario(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml", overrides);
}

/// So low that the brake holds a wheel that slides.
inline constexpr const char* kSlippery = "wheel_rail.adhesion.friction_coefficient=0.02";

/// The vehicle of the paper's train.
inline VehicleParams OreWagon(const std::vector<std::string>& overrides = {}) {
  return config::LoadVehicle(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/vehicles/ore_wagon.yaml", overrides);
}

/// Vehicles in the middle of a stop and what acts on them; no two under the same load.
template <class Vehicle>
class MovingVehicles {
 public:
  using State = typename VehicleBatch<Vehicle>::State;

  /// @param start  every vehicle's state, about 80 km/h; two seconds under the brake follow
  MovingVehicles(Vehicle vehicle_, const State& start) : vehicle(std::move(vehicle_)), states(kVehicles, start) {
    for (int i = 0; i <= kVehicles; ++i) {
      const double share = static_cast<double>(i) / kVehicles;
      loads_.coupler_force_n.push_back(4e5 * (share - 0.5));
      loads_.cylinder_pressure_pa.push_back(3.3e5 + 1e5 * share);
    }
    ResizeReply(kVehicles, reply_);
    VehicleBatch<Vehicle> batch(vehicle, BestLaneKernels(kVehicles), states);
    batch.Advance(track, kTimeStep, 2000, loads(), reply(), true);
    for (int i = 0; i < kVehicles; ++i) states[i] = batch.StateOf(i);
  }

  LoadPlaces loads() const { return PlacesOf(loads_, 0); }
  ReplyPlaces reply() { return PlacesOf(reply_, 0); }

  Vehicle vehicle;
  Track track;
  std::vector<State> states;

 private:
  LoadArrays loads_;
  ReplyArrays reply_;
};

inline MovingVehicles<Wagon> RollingWagons() {
  const Wagon wagon(OreWagon());
  return {wagon, StaticEquilibrium(wagon, 0.0, 80.0 / 3.6)};
}

/// Wagons that slide with all wheels locked.
inline MovingVehicles<Wagon> SlidingWagons() {
  const Wagon wagon(OreWagon({kSlippery}));
  WagonState<double> start = StaticEquilibrium(wagon, 0.0, 80.0 / 3.6);
  for (int i = 0; i < kWheelsets; ++i) start.velocity.pitch[kWheelset1 + i] = 0.0;
  return {wagon, start};
}

inline MovingVehicles<LtdVehicle> RollingLtdVehicles() {
  LtdState<double> start;
  start.v_mps = 80.0 / 3.6;
  return {LtdVehicle(OreWagon(), true), start};
}

}  // namespace train_dynamics::bench
