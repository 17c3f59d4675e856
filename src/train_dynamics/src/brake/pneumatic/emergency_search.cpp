#include "train_dynamics/brake/pneumatic/emergency_search.h"

#include <algorithm>
#include <random>

namespace train_dynamics {
namespace {

constexpr double kLookEvery = 0.25;  // [s]; an emergency lasts

/// A number in [low, high), the same on every machine: the standard's distributions need not be.
double Uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 5) / static_cast<double>(1 << 27);
}

int FirstInEmergency(const PneumaticBrake& brake) {
  for (int i = 0; i < brake.vehicles(); ++i)
    if (brake.valve(i).Mode() == ControlValveMode::kEmergency) return i;
  return -1;
}

}  // namespace

std::vector<UndesiredEmergency> FindUndesiredEmergencies(PneumaticBrakeParams params,
                                                         const std::vector<double>& vehicle_length_m,
                                                         const EmergencySearch& search) {
  params.pipe.cells_per_vehicle = search.cells_per_vehicle;
  params.parted_hoses.clear();
  for (PipeSourceParams& source : params.sources) source.commands.clear();
  const int vehicles = static_cast<int>(vehicle_length_m.size());
  bool steps_back = true;
  for (int valve : params.ValveOfVehicle(vehicles))
    steps_back = steps_back && params.valves[valve].kind != ControlValveKind::kDirectRelease;
  const double most_kpa = params.drivers_valve.full_service_reduction_kpa + 30.0;

  std::mt19937 random(search.seed);
  std::vector<UndesiredEmergency> found;
  std::vector<double> cylinder_pa;
  for (int trial = 1; trial <= search.trials; ++trial) {
    double initial_kpa = params.charged_pressure_kpa;
    if (trial % 3 == 0) initial_kpa = trial % 2 == 0 ? 0.0 : Uniform(random, 0.0, params.charged_pressure_kpa);
    params.initial_pressure_kpa = initial_kpa;
    PneumaticBrake brake(params, vehicle_length_m);
    UndesiredEmergency run{trial, 0, 0.0, initial_kpa, {}};
    double time_s = 0.0, reduction_kpa = 0.0;
    for (int command = 0; command <= search.commands && run.vehicle == 0; ++command) {
      const double end_s = time_s + Uniform(random, 0.1, 2.0 * search.mean_pause_s);
      while (time_s < end_s && run.vehicle == 0) {
        time_s = std::min(end_s, time_s + kLookEvery);
        brake.PressuresAt(time_s, cylinder_pa);
        run.vehicle = FirstInEmergency(brake) + 1;
      }
      if (command == search.commands || run.vehicle > 0) break;
      BrakeCommand next{time_s, BrakeCommandKind::kRelease, 0.0};
      const double least_kpa = steps_back ? 15.0 : std::max(15.0, reduction_kpa);
      if (Uniform(random, 0.0, 1.0) >= 0.4 && least_kpa < most_kpa) {
        next = {time_s, BrakeCommandKind::kApply, Uniform(random, least_kpa, most_kpa)};
        reduction_kpa = next.reduction_kpa;
      } else {
        reduction_kpa = 0.0;
      }
      brake.Command(next);
      run.commands.push_back(next);
    }
    run.time_s = time_s;
    if (run.vehicle > 0) found.push_back(run);
  }
  return found;
}

}  // namespace train_dynamics
