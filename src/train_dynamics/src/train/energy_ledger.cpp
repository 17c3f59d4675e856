#include "train_dynamics/train/energy_ledger.h"

namespace train_dynamics {

double EnergyLedger::Dissipated() const {
  double sum = 0.0;
  for (const auto& element : dissipated_j) sum += element.second;
  return sum;
}

EnergyLedger MakeEnergyLedger(double time_s, const std::vector<VehicleEnergy>& vehicles,
                              const ConnectionEnergy& connections) {
  EnergyLedger ledger;
  ledger.time_s = time_s;
  for (const char* name : kDissipationNames) ledger.dissipated_j.emplace_back(name, 0.0);
  for (const VehicleEnergy& vehicle : vehicles) {
    ledger.kinetic_j += vehicle.kinetic_j;
    ledger.potential_j += vehicle.potential_j;
    ledger.gravity_work_j += vehicle.gravity_work_j;
    ledger.traction_work_j += vehicle.traction_work_j;
    for (int i = 0; i < kDissipations; ++i) ledger.dissipated_j[i].second += vehicle.dissipated_j[i];
  }
  ledger.potential_j += connections.potential;
  ledger.dissipated_j.emplace_back("draft_gears", connections.draft_gears);
  ledger.dissipated_j.emplace_back("draw_bars", connections.draw_bars);
  if (connections.external) ledger.dissipated_j.emplace_back("external_vehicles", *connections.external);
  return ledger;
}

}  // namespace train_dynamics
