#include "train_brake_rviz/board/quantity.h"

#include <algorithm>
#include <cmath>

namespace train_brake_rviz {

std::vector<double> VehicleCouplerForces(const Snapshot& snapshot) {
  const std::vector<double>& force = snapshot.coupler_force_n;
  std::vector<double> larger(force.size() + 1);
  if (larger.size() != snapshot.position_m.size()) return {};
  for (size_t i = 0; i < larger.size(); ++i) {
    const double front = i == 0 ? 0.0 : force[i - 1], rear = i == force.size() ? 0.0 : force[i];
    larger[i] = std::abs(front) > std::abs(rear) ? front : rear;
  }
  return larger;
}

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> kQuantities = {
      {"coupler_force", "coupler force", "kN", 1e-3, 100.0, true, "compression", "tension", VehicleCouplerForces},
      {"pressure", "cylinder pressure", "kPa", 1e-3, 100.0, false, "", "",
       [](const Snapshot& s) { return s.cylinder_pressure_pa; }},
      {"pipe_pressure", "brake pipe pressure", "kPa", 1e-3, 100.0, false, "", "",
       [](const Snapshot& s) { return s.pipe_pressure_pa; }},
      {"slip", "wheel slip", "%", 100.0, 0.05, false, "", "",
       [](const Snapshot& s) {
         std::vector<double> size = s.creepage;
         for (double& creepage : size) creepage = std::abs(creepage);
         return size;
       }},
      {"acceleration", "acceleration", "m/s²", 1.0, 0.2, true, "braking", "speeding up",
       [](const Snapshot& s) { return s.acceleration_mps2; }},
  };
  return kQuantities;
}

const Quantity* FindQuantity(const std::string& name) {
  const auto& all = Quantities();
  const auto found = std::find_if(all.begin(), all.end(), [&name](const auto& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Color ColorOf(const Quantity& quantity, double value, double limit) {
  return quantity.diverging ? Diverging(value / limit) : Sequential(value / limit);
}

}  // namespace train_brake_rviz
