#include "train_sim/vehicle_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/vehicle/wagon_modes.h"
#include "train_sim/run_command.h"

namespace train_sim {
namespace {

using train_dynamics::WagonMode;
using train_dynamics::WagonModes;

/// A motion with its share in the kinetic energy of a mode: {0.98, "carbody z"}.
using EnergyShare = std::pair<double, std::string>;

/// The three motions that carry most of a mode's kinetic energy, without those below 1 %.
template <int kPerBogie>
std::vector<EnergyShare> LargestShares(const WagonMode<kPerBogie>& mode) {
  std::vector<EnergyShare> motions;
  for (int b = 0; b < train_dynamics::kBodiesOf<kPerBogie>; ++b) {
    const std::string body = train_dynamics::kBodyNames[b];
    motions.emplace_back(mode.energy_share.x[b], body + " x");
    motions.emplace_back(mode.energy_share.z[b], body + " z");
    motions.emplace_back(mode.energy_share.pitch[b], body + " pitch");
  }
  std::partial_sort(motions.begin(), motions.begin() + 3, motions.end(), std::greater<>());
  motions.resize(3);
  while (!motions.empty() && motions.back().first < 0.01) motions.pop_back();
  return motions;
}

/// "carbody z 98 %, front bolster z 1 %".
std::string InWords(const std::vector<EnergyShare>& shares) {
  std::string text;
  for (const auto& [share, motion] : shares)
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", motion, 100.0 * share);
  return text;
}

/// The modes with their whole shapes: largest component 1, metres and radians alike.
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
    train_console::Print("{:>5} {:>12.3f} {:>8.2f}%   {}\n", number++, mode.frequency_hz, 100.0 * mode.damping_ratio,
                         InWords(LargestShares(mode)));
  }
  train_console::Print("\nrigid-body motions: {} (travel, rotation of the wheelsets)\n", analysis.rigid_body_modes);
  train_console::Print("largest stable explicit step: {:.3f} ms\n", 1e3 * analysis.largest_stable_step_s);
}

template <int kPerBogie>
void PrintJson(const train_dynamics::BogieVehicle<kPerBogie>& wagon, const WagonModes<kPerBogie>& analysis) {
  nlohmann::ordered_json modes = nlohmann::ordered_json::array();
  for (const WagonMode<kPerBogie>& mode : analysis.modes) {
    nlohmann::ordered_json shares = nlohmann::ordered_json::object();
    for (const auto& [share, motion] : LargestShares(mode)) shares[motion] = share;
    modes.push_back({{"frequency_hz", mode.frequency_hz},
                     {"damping_ratio", mode.damping_ratio},
                     {"largest_energy_shares", std::move(shares)}});
  }
  const nlohmann::ordered_json json = {{"vehicle", wagon.params.name},
                                       {"mass_kg", wagon.params.TotalMass()},
                                       {"rigid_body_modes", analysis.rigid_body_modes},
                                       {"largest_stable_step_s", analysis.largest_stable_step_s},
                                       {"modes", std::move(modes)}};
  train_console::WriteOutput(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace

int PrintModes(const std::string& vehicle_file, const std::vector<std::string>& overrides, ModesFormat format) {
  const auto print = [format](const auto& wagon) {
    const auto analysis = train_dynamics::AnalyseModes(wagon);
    switch (format) {
      case ModesFormat::kText:
        return PrintTable(wagon, analysis);
      case ModesFormat::kCsv:
        return PrintShapes(analysis);
      case ModesFormat::kJson:
        return PrintJson(wagon, analysis);
    }
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
    const double creepage = i == 0 ? 0.0 : std::pow(10.0, -4.0 + 4.0 * (i - 1) / (kPoints - 2));  // 0.01 % ... 100 %
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
