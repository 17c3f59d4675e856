#include "train_dynamics/train/consist.h"

namespace train_dynamics {

int TrainParams::VehicleCount() const {
  long count = 0;
  for (const ConsistGroupParams& group : consist) count += group.count;
  return static_cast<int>(count < 1000000 ? count : 1000000);
}

const VehicleParams& TrainParams::VehicleAt(int index) const {
  std::size_t group = 0;
  while (index >= consist[group].count) index -= consist[group++].count;
  return consist[group].vehicle;
}

Consist::Consist(const TrainParams& train) {
  connection_types.push_back(train.connection);
  for (const ConsistGroupParams& group : train.consist) {
    const int type = static_cast<int>(vehicle_types.size());
    vehicle_types.push_back(group.vehicle);
    command_delay_s.push_back(group.command_delay_s);
    initial_notch.push_back({group.initial_throttle_notch, group.initial_dynamic_brake_notch});
    initial_slack.push_back(group.initial_slack);
    int within_unit = 0;
    if (group.vehicles_per_unit > 1) {
      within_unit = static_cast<int>(connection_types.size());
      connection_types.push_back(group.unit_connection);
    }
    for (int i = 0; i < group.count; ++i) {
      if (vehicle_type.empty()) {
        centre_m.push_back(0.0);
      } else {
        connection_type.push_back(i % group.vehicles_per_unit == 0 ? 0 : within_unit);
        centre_m.push_back(centre_m.back() - 0.5 * (vehicle(vehicles() - 1).length_m + group.vehicle.length_m));
      }
      if (group.locomotive || group.vehicle.traction) locomotives.push_back(vehicles());
      vehicle_type.push_back(type);
    }
  }
}

}  // namespace train_dynamics
