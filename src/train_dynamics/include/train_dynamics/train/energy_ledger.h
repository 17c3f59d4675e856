#pragma once

#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/train/in_train_forces.h"
#include "train_dynamics/train/lockstep.h"

namespace train_dynamics {

/// The energy of a whole train and where it went [J].
///
///   kinetic + potential + sum of dissipated = initial + gravity_work + traction_work + residual
///
/// Every term is found by its own route: kinetic and potential energy from the state, works from force x path, step by
/// step. Of external vehicles only the work of their couplers is known, which leaves the rest of the train; its account
/// is `external_vehicles`. The residual therefore measures what the time integration creates or loses.
struct EnergyLedger {
  double time_s = 0.0;
  double kinetic_j = 0.0;
  double potential_j = 0.0;     ///< springs, contacts and height of all bodies, and the connections' springs
  double gravity_work_j = 0.0;  ///< of the grade
  double traction_work_j = 0.0;
  std::vector<std::pair<std::string, double>> dissipated_j;  ///< by element

  double Stored() const { return kinetic_j + potential_j; }
  double Dissipated() const;
  double Residual(double initial_j) const {
    return Stored() + Dissipated() - initial_j - gravity_work_j - traction_work_j;
  }
};

/// Adds up the energies of vehicles, in their order, and connections.
EnergyLedger MakeEnergyLedger(double time_s, const std::vector<VehicleEnergy>& vehicles,
                              const ConnectionEnergy& connections);

}  // namespace train_dynamics
