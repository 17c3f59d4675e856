#include "train_sim/vehicle_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/vehicle/wagon_modes.h"
#include "train_sim/run_command.h"

namespace train_sim {
namespace {

using train_dynamics::WagonMode;
using train_dynamics::WagonModes;

/// The motions that carry most of a mode's kinetic energy, as "carbody z 98 %, front bolster z 1 %".
template <int kPerBogie>
std::string LargestMotions(const WagonMode<kPerBogie>& mode) {
  std::vector<std::pair<double, std::string>> motions;
  for (int b = 0; b < train_dynamics::kBodiesOf<kPerBogie>; ++b) {
    const std::string body = train_dynamics::kBodyNames[b];
    motions.emplace_back(mode.energy_share.x[b], body + " x");
    motions.emplace_back(mode.energy_share.z[b], body + " z");
    motions.emplace_back(mode.energy_share.pitch[b], body + " pitch");
  }
  std::partial_sort(motions.begin(), motions.begin() + 3, motions.end(), std::greater<>());
  std::string text;
  for (int i = 0; i < 3; ++i) {
    if (motions[i].first < 0.01) break;
    text += fmt::format("{}{} {:.0f} %", i > 0 ? ", " : "", motions[i].second, 100.0 * motions[i].first);
  }
  return text;
}

/// The whole shapes: largest component 1, metres and radians alike.
template <int kPerBogie>
void PrintShapes(const WagonModes<kPerBogie>& analysis) {
  train_console::Print("mode,frequency_hz,damping_ratio");
  for (int b = 0; b < train_dynamics::kBodiesOf<kPerBogie>; ++b) {
    std::string name = train_dynamics::kBodyNames[b];
    std::replace(name.begin(), name.end(), ' ', '_');
    train_console::Print(",{0}_x,{0}_z,{0}_pitch", name);
  }
  int number = 1;
  for (const WagonMode<kPerBogie>& mode : analysis.modes) {
    train_console::Print("\n{},{:.6g},{:.6g}", number++, mode.frequency_hz, mode.damping_ratio);
    for (int b = 0; b < train_dynamics::kBodiesOf<kPerBogie>; ++b) {
      train_console::Print(",{:.4g},{:.4g},{:.4g}", mode.shape.x[b], mode.shape.z[b], mode.shape.pitch[b]);
    }
  }
  train_console::Print("\n");
}

template <int kPerBogie>
void PrintTable(const train_dynamics::BogieVehicle<kPerBogie>& wagon, const WagonModes<kPerBogie>& analysis) {
  train_console::Print("{}: {:.1f} kg, linearised about its static equilibrium, wedges without friction\n\n",
                       wagon.params.name, wagon.params.TotalMass());
  train_console::Print("{:>5} {:>12} {:>9}   {}\n", "mode", "frequency_hz", "damping",
                       "largest shares of the kinetic energy");
  int number = 1;
  for (const WagonMode<kPerBogie>& mode : analysis.modes) {
    train_console::Print("{:>5} {:>12.3f} {:>8.2f}%   {}\n", number++, mode.frequency_hz,
                         100.0 * mode.damping_ratio, LargestMotions(mode));
  }
  train_console::Print("\nrigid-body motions: {} (travel, rotation of the wheelsets)\n",
                       analysis.rigid_body_modes);
  train_console::Print("largest stable explicit step: {:.3f} ms\n", 1e3 * analysis.largest_stable_step_s);
}

}  // namespace

int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv) {
  const auto print = [csv](const auto& wagon) {
    const auto analysis = train_dynamics::AnalyseModes(wagon);
    csv ? PrintShapes(analysis) : PrintTable(wagon, analysis);
  };
  train_dynamics::WithBogieVehicle(train_dynamics::config::LoadVehicle(vehicle_file, overrides), print);
  return train_run::kSuccess;
}

int PrintAdhesion(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv) {
  const train_dynamics::VehicleParams vehicle = train_dynamics::config::LoadVehicle(vehicle_file, overrides);
  const train_dynamics::WheelRailParams& contact = vehicle.wheel_rail;
  const double creep_stiffness =
      train_dynamics::WithBogieVehicle(vehicle, [](const auto& wagon) { return wagon.creep_stiffness; });
  const double load_n = vehicle.Weight() / vehicle.Wheelsets();
  const std::vector<double> speeds_kmh = {5, 20, 40, 80, 120};
  if (!csv) {
    train_console::Print("{}: coefficient of adhesion at {:.1f} kN per wheelset, mu0 {:g}\n\n", vehicle.name,
                         1e-3 * load_n, contact.adhesion.friction_coefficient);
  }
  train_console::Print(csv ? "creepage" : "{:>9}", "creepage");
  for (double speed : speeds_kmh)
    train_console::Print(fmt::runtime(csv ? ",adhesion_at_{:g}_kmh" : " {:>5g} km/h"), speed);
  train_console::Print("\n");
  constexpr int kPoints = 41;
  for (int i = 0; i < kPoints; ++i) {
    const double creepage =
        i == 0 ? 0.0 : std::pow(10.0, -4.0 + 4.0 * (i - 1) / (kPoints - 2));  // 0.01 % ... 100 %
    train_console::Print(fmt::runtime(csv ? "{:.6g}" : "{:>9.5f}"), creepage);
    for (double speed : speeds_kmh) {
      const double v = speed / 3.6;
      const auto law = train_dynamics::FreezeCreepLaw(contact.adhesion, creep_stiffness, load_n,
                                                      contact.adhesion.friction_coefficient, v,
                                                      contact.creepage_regularisation_speed_mps);
      const double adhesion = train_dynamics::PolachForce(law, creepage * v).force / load_n;
      train_console::Print(fmt::runtime(csv ? ",{:.6g}" : " {:>10.5f}"), adhesion);
    }
    train_console::Print("\n");
  }
  return train_run::kSuccess;
}

}  // namespace train_sim
