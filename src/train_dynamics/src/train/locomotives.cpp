#include "train_dynamics/train/locomotives.h"

#include <algorithm>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {

Locomotives::Locomotives(const Consist& consist, const std::vector<LocomotiveCommand>& commands)
    : vehicles_(consist.vehicles()) {
  for (int i = 0; i < consist.vehicles(); ++i) {
    const VehicleParams& vehicle = consist.vehicle(i);
    if (!vehicle.traction) continue;
    Drive drive;
    drive.vehicle = i;
    drive.traction = *vehicle.traction;
    drive.driven_weight_n = vehicle.DrivenWeight();
    drive.command_delay_s = consist.command_delay_s[consist.vehicle_type[i]];
    drives_.push_back(drive);
  }
  for (const LocomotiveCommand& command : commands) Command(command);
}

void Locomotives::Command(const LocomotiveCommand& command) {
  for (Drive& drive : drives_) {
    const bool is_named = std::any_of(command.vehicles.begin(), command.vehicles.end(),
                                      [&](int number) { return VehicleIndex(number, vehicles_) == drive.vehicle; });
    if (!command.vehicles.empty() && !is_named) continue;
    const Order order{command.time_s + drive.command_delay_s, command.Notches()};
    const auto at = std::upper_bound(drive.orders.begin(), drive.orders.end(), order,
                                     [](const Order& a, const Order& b) { return a.time_s < b.time_s; });
    drive.orders.insert(at, order);
  }
}

void Locomotives::Begin(const Consist& consist, const std::vector<double>& head_velocity_mps) {
  for (Drive& drive : drives_) {
    drive.command = consist.initial_notch[consist.vehicle_type[drive.vehicle]];
    const double effort_n =
        WantedEffort(drive.traction, drive.command, head_velocity_mps[drive.vehicle], drive.driven_weight_n);
    drive.state.effort_n = effort_n;
    drive.state.side = effort_n > 0.0 ? 1.0 : effort_n < 0.0 ? -1.0 : 0.0;
  }
}

void Locomotives::Advance(double middle_s, double interval_s, const std::vector<double>& head_velocity_mps,
                          LoadArrays& loads) {
  if (drives_.empty()) return;
  loads.traction_n.resize(head_velocity_mps.size());
  loads.dynamic_brake_n.resize(head_velocity_mps.size());
  for (Drive& drive : drives_) {
    for (; drive.obeyed < drive.orders.size() && drive.orders[drive.obeyed].time_s <= middle_s; ++drive.obeyed)
      drive.command = drive.orders[drive.obeyed].command;
    const double speed_mps = head_velocity_mps[drive.vehicle];
    StepDrive(drive.traction.drive, WantedEffort(drive.traction, drive.command, speed_mps, drive.driven_weight_n),
              interval_s, drive.state);
    const double effort_n = drive.state.effort_n;
    loads.traction_n[drive.vehicle] = Max(0.0, effort_n);
    loads.dynamic_brake_n[drive.vehicle] = Max(0.0, -effort_n);
    if (!drive.traction.energy_supply) continue;
    const double rim_power_w = effort_n > 0.0 ? effort_n * speed_mps : effort_n * Abs(speed_mps);
    drive.energy_taken_j +=
        interval_s * PowerTaken(*drive.traction.energy_supply, rim_power_w, drive.traction.tractive_effort.rim_power_w);
  }
}

void Locomotives::PassBy(double middle_s) {
  for (Drive& drive : drives_) {
    while (drive.obeyed < drive.orders.size() && drive.orders[drive.obeyed].time_s <= middle_s) ++drive.obeyed;
  }
}

double Locomotives::EnergyTaken() const {
  double sum = 0.0;
  for (const Drive& drive : drives_) sum += drive.energy_taken_j;
  return sum;
}

bool Locomotives::TellsEnergy() const {
  return std::any_of(drives_.begin(), drives_.end(),
                     [](const Drive& drive) { return drive.traction.energy_supply.has_value(); });
}

double Locomotives::FuelMass() const {
  double sum = 0.0;
  for (const Drive& drive : drives_) {
    const auto& supply = drive.traction.energy_supply;
    if (supply && supply->fuel_energy_j_per_kg) sum += drive.energy_taken_j / *supply->fuel_energy_j_per_kg;
  }
  return sum;
}

}  // namespace train_dynamics
