#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

BrakeSystem::System Make(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
                         const std::vector<double>& vehicle_positions_m, const PressureGrid& grid) {
  return BrakePressures(AirBrake(params.empirical, commands, vehicle_positions_m),
                        0.5 * grid.exchange_interval_s, 2 * grid.exchanges_per_record);
}

}  // namespace

BrakeSystem::BrakeSystem(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
                         const std::vector<double>& vehicle_positions_m, const PressureGrid& grid)
    : system_(Make(params, commands, vehicle_positions_m, grid)) {}

}  // namespace train_dynamics
