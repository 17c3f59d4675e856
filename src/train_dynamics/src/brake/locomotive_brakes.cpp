#include "train_dynamics/brake/locomotive_brakes.h"

#include <algorithm>

#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {

LocomotiveBrakes::LocomotiveBrakes(const LocomotiveBrakeParams& params, const std::vector<Locomotive>& locomotives,
                                   int vehicles)
    : params_(params), vehicles_(vehicles) {
  for (const Locomotive& locomotive : locomotives) {
    Brake brake;
    brake.vehicle = locomotive.vehicle;
    brake.command_delay_s = locomotive.command_delay_s;
    brakes_.push_back(brake);
  }
  is_used_ = blends();
}

std::vector<LocomotiveBrakes::BailOff> LocomotiveBrakes::Command(const LocomotiveBrakeCommand& command) {
  std::vector<BailOff> bail_offs;
  for (Brake& brake : brakes_) {
    const bool is_named = std::any_of(command.vehicles.begin(), command.vehicles.end(),
                                      [&](int number) { return VehicleIndex(number, vehicles_) == brake.vehicle; });
    if (!command.vehicles.empty() && !is_named) continue;
    const double at_s = command.time_s + brake.command_delay_s;
    if (command.kind == LocomotiveBrakeCommandKind::kBailOff) {
      bail_offs.push_back({brake.vehicle, at_s, at_s + params_.bail_off_time_s});
      continue;
    }
    const Order order{at_s, 1e3 * command.pressure_kpa};
    const auto place = std::upper_bound(brake.orders.begin(), brake.orders.end(), order,
                                        [](const Order& a, const Order& b) { return a.time_s < b.time_s; });
    brake.orders.insert(place, order);
    is_used_ = true;
  }
  return bail_offs;
}

double LocomotiveBrakes::PressureOf(const Brake& brake, double time_s) const {
  const double since_s = time_s - brake.from_s;
  return brake.goal_pa > brake.from_pa
             ? Min(brake.goal_pa, brake.from_pa + 1e3 * params_.independent_fill_kpa_per_s * since_s)
             : Max(brake.goal_pa, brake.from_pa - 1e3 * params_.independent_release_kpa_per_s * since_s);
}

void LocomotiveBrakes::Act(double time_s, std::vector<double>& pressure_pa) {
  if (!is_used_) return;
  for (Brake& brake : brakes_) {
    for (; brake.obeyed < brake.orders.size() && brake.orders[brake.obeyed].time_s <= time_s; ++brake.obeyed) {
      const Order& order = brake.orders[brake.obeyed];
      brake.from_pa = PressureOf(brake, order.time_s);
      brake.from_s = order.time_s;
      brake.goal_pa = order.pressure_pa;
    }
    double& pressure = pressure_pa[brake.vehicle];
    // [kPa/kN] is [Pa/N].
    const double automatic = Max(0.0, pressure - params_.blending_kpa_per_kn * brake.dynamic_n);
    pressure = Max(automatic, PressureOf(brake, time_s));
  }
}

}  // namespace train_dynamics
