#include "train_sim/vehicle_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/vehicle/wagon_modes.h"
#include "train_sim/run_command.h"

namespace train_sim {
namespace {

using train_dynamics::WagonMode;

/// The motions that carry most of a mode's kinetic energy, as "carbody z 98 %, front bolster z 1 %".
std::string LargestMotions(const WagonMode& mode) {
  std::vector<std::pair<double, std::string>> motions;
  for (int b = 0; b < train_dynamics::kBodies; ++b) {
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
void PrintShapes(const train_dynamics::WagonModes& analysis) {
  fmt::print("mode,frequency_hz,damping_ratio");
  for (const char* body : train_dynamics::kBodyNames) {
    std::string name = body;
    std::replace(name.begin(), name.end(), ' ', '_');
    fmt::print(",{0}_x,{0}_z,{0}_pitch", name);
  }
  int number = 1;
  for (const WagonMode& mode : analysis.modes) {
    fmt::print("\n{},{:.6g},{:.6g}", number++, mode.frequency_hz, mode.damping_ratio);
    for (int b = 0; b < train_dynamics::kBodies; ++b) {
      fmt::print(",{:.4g},{:.4g},{:.4g}", mode.shape.x[b], mode.shape.z[b], mode.shape.pitch[b]);
    }
  }
  fmt::print("\n");
}

}  // namespace

int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv) {
  const train_dynamics::Wagon wagon(train_dynamics::config::LoadVehicle(vehicle_file, overrides));
  const train_dynamics::WagonModes analysis = train_dynamics::AnalyseModes(wagon);
  if (csv) {
    PrintShapes(analysis);
    return train_run::kSuccess;
  }
  fmt::print("{}: {:.1f} kg, linearised about its static equilibrium, wedges without friction\n\n",
             wagon.params.name, wagon.params.TotalMass());
  fmt::print("{:>5} {:>12} {:>9}   {}\n", "mode", "frequency_hz", "damping",
             "largest shares of the kinetic energy");
  int number = 1;
  for (const WagonMode& mode : analysis.modes) {
    fmt::print("{:>5} {:>12.3f} {:>8.2f}%   {}\n", number++, mode.frequency_hz, 100.0 * mode.damping_ratio,
               LargestMotions(mode));
  }
  fmt::print("\nrigid-body motions: {} (travel, rotation of the wheelsets)\n", analysis.rigid_body_modes);
  fmt::print("largest stable explicit step: {:.3f} ms\n", 1e3 * analysis.largest_stable_step_s);
  return train_run::kSuccess;
}

int PrintAdhesion(const std::string& vehicle_file, const std::vector<std::string>& overrides, bool csv) {
  const train_dynamics::Wagon wagon(train_dynamics::config::LoadVehicle(vehicle_file, overrides));
  const train_dynamics::WheelRailParams& contact = wagon.params.wheel_rail;
  const double load_n = wagon.weight_n / train_dynamics::kWheelsets;
  const std::vector<double> speeds_kmh = {5, 20, 40, 80, 120};
  if (!csv) {
    fmt::print("{}: coefficient of adhesion at {:.1f} kN per wheelset, mu0 {:g}\n\n", wagon.params.name,
               1e-3 * load_n, contact.adhesion.friction_coefficient);
  }
  fmt::print(csv ? "creepage" : "{:>9}", "creepage");
  for (double speed : speeds_kmh)
    fmt::print(fmt::runtime(csv ? ",adhesion_at_{:g}_kmh" : " {:>5g} km/h"), speed);
  fmt::print("\n");
  constexpr int kPoints = 41;
  for (int i = 0; i < kPoints; ++i) {
    const double creepage =
        i == 0 ? 0.0 : std::pow(10.0, -4.0 + 4.0 * (i - 1) / (kPoints - 2));  // 0.01 % ... 100 %
    fmt::print(fmt::runtime(csv ? "{:.6g}" : "{:>9.5f}"), creepage);
    for (double speed : speeds_kmh) {
      const double v = speed / 3.6;
      const auto law = train_dynamics::FreezeCreepLaw(contact.adhesion, wagon.creep_stiffness, load_n,
                                                      contact.adhesion.friction_coefficient, v,
                                                      contact.creepage_regularisation_speed_mps);
      const double adhesion = train_dynamics::PolachForce(law, creepage * v).force / load_n;
      fmt::print(fmt::runtime(csv ? ",{:.6g}" : " {:>10.5f}"), adhesion);
    }
    fmt::print("\n");
  }
  return train_run::kSuccess;
}

}  // namespace train_sim
