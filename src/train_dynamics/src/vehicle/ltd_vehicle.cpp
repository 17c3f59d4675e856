#include "train_dynamics/vehicle/ltd_vehicle.h"

#include "strict_config/validate.h"

namespace train_dynamics {

LtdVehicle::LtdVehicle(const VehicleParams& params, bool with_rotational_inertia, LtdIntegrator method,
                       bool knows_adhesion_limit)
    : brake_rigging(params.Rigging()),
      propulsion_resistance(params.Resistance()),
      weight_n(params.Weight()),
      inertia_kg(params.TotalMass() + (with_rotational_inertia ? EquivalentRotationalMass(params) : 0.0)),
      per_wheel(0.5 / params.Wheelsets()),
      integrator(method),
      adhesion_limit(knows_adhesion_limit && !params.IsOneMass()),
      adhesion(params.wheel_rail.adhesion),
      limit_n(params.Weight() * inertia_kg / params.TotalMass()) {
  strict_config::Validate(params);
}

}  // namespace train_dynamics
