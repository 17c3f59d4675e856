#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

BrakeSystem::System Make(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
                         const std::vector<double>& vehicle_positions_m, const PressureGrid& grid,
                         const std::vector<double>& vehicle_length_m) {
  if (params.kind == BrakeSystemKind::kPneumatic)
    return PneumaticBrake(params.pneumatic, vehicle_length_m, commands);
  return BrakePressures(AirBrake(params.empirical, commands, vehicle_positions_m),
                        0.5 * grid.exchange_interval_s, 2 * grid.exchanges_per_record);
}

}  // namespace

BrakeSystem::BrakeSystem(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
                         const std::vector<double>& vehicle_positions_m, const PressureGrid& grid,
                         const std::vector<double>& vehicle_length_m)
    : system_(Make(params, commands, vehicle_positions_m, grid, vehicle_length_m)) {}

}  // namespace train_dynamics
