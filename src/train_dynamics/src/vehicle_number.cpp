#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {

int VehicleIndex(int number, int vehicles) {
  const int index = number > 0 ? number - 1 : vehicles + number;
  return number != 0 && index >= 0 && index < vehicles ? index : -1;
}

std::string VehicleRule(int vehicles) {
  if (vehicles == 1) return "must be 1 or -1, because the train has 1 vehicle";
  const std::string n = std::to_string(vehicles);
  return "must be in [1, " + n + "], or in [-" + n + ", -1] from the rear, because the train has " + n + " vehicles";
}

}  // namespace train_dynamics
