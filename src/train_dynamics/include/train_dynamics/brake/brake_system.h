#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "train_dynamics/brake/air_brake.h"
#include "train_dynamics/brake/brake_command.h"
#include "train_dynamics/brake/brake_pressures.h"
#include "train_dynamics/brake/locomotive_brakes.h"
#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"
#include "train_dynamics/brake/pressure_table.h"
#include "train_dynamics/judgement.h"

namespace train_dynamics {

enum class BrakeSystemKind { kEmpirical, kPneumatic };

/// A brake system that turns the driver's commands into cylinder pressures.
struct BrakeSystemParams {
  std::string name;
  BrakeSystemKind kind = BrakeSystemKind::kEmpirical;
  AirBrakeParams empirical;
  PneumaticBrakeParams pneumatic;
  LocomotiveBrakeParams locomotive_brake;  ///< of either kind

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the brake system, for people");
    v.Choice("kind", kind, {{"empirical", BrakeSystemKind::kEmpirical}, {"pneumatic", BrakeSystemKind::kPneumatic}},
             "empirical: pressures by measured rates and wave speeds; pneumatic: flow of air in pipe, valves "
             "and cylinders");
    if (kind == BrakeSystemKind::kEmpirical) empirical.Visit(v);
    if (kind == BrakeSystemKind::kPneumatic) pneumatic.Visit(v);
    v.Group("locomotive_brake", locomotive_brake, "brakes of the locomotives besides that of the train");
  }

  /// function(the parameters of this kind). The compiler asks for the entry of a new kind.
  template <class Function>
  auto OfKind(Function&& function) const {
    switch (kind) {
      case BrakeSystemKind::kPneumatic:
        return function(pneumatic);
      case BrakeSystemKind::kEmpirical:
        break;
    }
    return function(empirical);
  }

  /// The rules that these commands break in a train of this many vehicles.
  std::vector<BrokenRule> BrokenRules(const std::vector<BrakeCommand>& commands, int vehicles) const {
    return OfKind([&](const auto& system) { return system.BrokenRules(commands, vehicles); });
  }
  std::vector<Warning> Warnings(const std::vector<BrakeCommand>& commands, int vehicles) const {
    return OfKind([&](const auto& system) { return system.Warnings(commands, vehicles); });
  }
  /// Whether a smaller reduction lowers all cylinders to its pressure.
  bool ReleasesGradually() const {
    return OfKind([](const auto& system) { return system.ReleasesGradually(); });
  }
};

/// The times at which pressures are queried: the middle of each exchange, and each record.
struct PressureGrid {
  double exchange_interval_s;
  int exchanges_per_record;
};

/// The brake of a train, one of a closed set of systems, chosen once per train. Each has
///
///   Command(command)                   adds a command of the driver, for now or later
///   BailOff(vehicle, from_s, to_s)     of pneumatic brakes: see there
///   OpenPipe(time_s, connection)       the brake pipe parts there: an emergency from both sides
///   PressuresAt(time_s, pressure_pa)   cylinder pressure of each vehicle [Pa]; times ascend
///   ForEachField(function)             calls function(number) for each number of its state
///
/// The list of fields serves saving, restoring and the digest of the train's state; see train/snapshot.h.
class BrakeSystem {
 public:
  using System = std::variant<BrakePressures, PressureTable, PneumaticBrake>;

  explicit BrakeSystem(System system) : system_(std::move(system)) {}
  /// @param vehicle_positions_m  see AirBrake
  /// @param vehicle_length_m  of each vehicle; a pneumatic brake needs them
  /// @throws std::invalid_argument as AirBrake
  BrakeSystem(const BrakeSystemParams& params, const std::vector<BrakeCommand>& commands,
              const std::vector<double>& vehicle_positions_m, const PressureGrid& grid,
              const std::vector<double>& vehicle_length_m = {});

  /// Sets the locomotives' own brakes, which act on their cylinders beside the system.
  void SetLocomotiveBrakes(LocomotiveBrakes locomotives) { locomotives_ = std::move(locomotives); }
  LocomotiveBrakes& locomotives() { return locomotives_; }

  /// Resizes `pressure_pa`.
  void PressuresAt(double time_s, std::vector<double>& pressure_pa) {
    std::visit([&](auto& system) { system.PressuresAt(time_s + ahead_s_, pressure_pa); }, system_);
    locomotives_.Act(time_s + ahead_s_, pressure_pa);
    for (const Trapped& air : trapped_) pressure_pa[air.vehicle] = air.pressure_pa;
  }
  /// @throws std::invalid_argument if the system cannot obey
  void Command(BrakeCommand command) {
    command.time_s += ahead_s_;
    std::visit([&](auto& system) { system.Command(command); }, system_);
  }
  void Command(LocomotiveBrakeCommand command) {
    command.time_s += ahead_s_;
    for (const LocomotiveBrakes::BailOff& bail_off : locomotives_.Command(command)) {
      if (auto* machine = std::get_if<PneumaticBrake>(&system_))
        machine->BailOff(bail_off.vehicle, bail_off.from_s, bail_off.to_s);
    }
  }
  void OpenPipe(double time_s, int connection) {
    std::visit([&](auto& system) { system.OpenPipe(time_s + ahead_s_, connection); }, system_);
  }
  /// The valve of a vehicle is cut out with this pressure in its cylinder, for good.
  void TrapAir(int vehicle, double pressure_pa) {
    trapped_.push_back({vehicle, pressure_pa});
    if (auto* machine = std::get_if<PneumaticBrake>(&system_)) machine->TrapAir(vehicle, pressure_pa);
  }
  /// Shifts all times passed from now on to this many seconds later.
  void MoveAhead(double seconds) { ahead_s_ += seconds; }

  /// The pneumatic brake at its last grid time not after that of PressuresAt; nullptr if the system is another one.
  const PneumaticBrake* pneumatic() const { return std::get_if<PneumaticBrake>(&system_); }

  template <class Function>
  void ForEachField(Function&& function) {
    std::visit([&](auto& system) { system.ForEachField(function); }, system_);
  }

 private:
  struct Trapped {
    int vehicle;
    double pressure_pa;
  };

  System system_;
  std::vector<Trapped> trapped_;
  LocomotiveBrakes locomotives_;
  double ahead_s_ = 0.0;
};

}  // namespace train_dynamics
