#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

/// What a brake is built from besides its parameters.
struct OfTrain {
  const std::vector<BrakeCommand>& commands;
  const std::vector<double>&vehicle_positions_m, &vehicle_length_m;
  const PressureGrid& grid;
};

BrakePressures Make(const AirBrakeParams& params, const OfTrain& train) {
  return {AirBrake(params, train.commands, train.vehicle_positions_m), 0.5 * train.grid.exchange_interval_s,
          2 * train.grid.exchanges_per_record};
}

PneumaticBrake Make(const PneumaticBrakeParams& params, const OfTrain& train) {
  return {params, train.vehicle_length_m, train.commands};
}

}  // namespace

BrakeSystem::BrakeSystem(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
                         const std::vector<double>& vehicle_positions_m, const PressureGrid& grid,
                         const std::vector<double>& vehicle_length_m)
    : system_(params.OfKind([&](const auto& of_kind) -> System {
        return Make(of_kind, {commands, vehicle_positions_m, vehicle_length_m, grid});
      })) {}

}  // namespace train_dynamics
