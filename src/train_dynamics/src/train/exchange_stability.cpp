#include "train_dynamics/train/exchange_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {

double LongestStableExchange(const ConnectionParams& connection, double head_mass_kg) {
  const auto at_large_force = [](const auto& law) { return law.TangentAt(kLargeCouplerForce); };
  const ConnectionTangent tangent = std::visit(at_large_force, connection.Law());
  const double k = tangent.stiffness_n_per_m, c = tangent.damping_ns_per_m;
  return head_mass_kg / (c + std::sqrt(c * c + k * head_mass_kg));
}

double CouplerHeadMass(const VehicleParams& vehicle, VehicleModel model) {
  if (model == VehicleModel::kLtdNoInertia) return vehicle.TotalMass();
  if (model == VehicleModel::kLtd) return vehicle.TotalMass() + EquivalentRotationalMass(vehicle);
  const BodyParams carbody = vehicle.LoadedCarbody();
  const double arm_m = vehicle.coupler_height_m - carbody.cg_height_m;
  return 1.0 / (1.0 / carbody.mass_kg + arm_m * arm_m / carbody.pitch_inertia_kgm2);
}

double LightestCouplerHead(const ScenarioParams& scenario) {
  double lightest_kg = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    lightest_kg = std::min(lightest_kg, CouplerHeadMass(scenario.train.consist[i].vehicle, scenario.ModelOfGroup(i)));
  }
  return lightest_kg;
}

}  // namespace train_dynamics
