#pragma once

#include <string>

namespace train_dynamics {

/// Index from 0 of a vehicle that is numbered from 1, or from -1 for the last; -1 if the train has no such
/// vehicle.
int VehicleIndex(int number, int vehicles);

/// What the number of a vehicle must be, as the rule of an error message.
std::string VehicleRule(int vehicles);

/// What such a rule reads in a scenario.
inline constexpr char kVehicleCounts[] = "train.consist[].count";

}  // namespace train_dynamics
