#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/train/consist.h"
#include "train_dynamics/train/locomotive_command.h"
#include "train_dynamics/vehicle/vehicle_loads.h"

namespace train_dynamics {

/// The drives of the locomotives of a train: from the driver's notches to the loads on their vehicles.
///
/// A locomotive is a vehicle with traction. Its effort over an exchange follows from its speed at the exchange's start,
/// which is that of its coupler heads.
class Locomotives {
 public:
  /// @param commands  with the lead's times; each group of locomotives receives them later by its delay
  Locomotives(const Consist& consist, const std::vector<LocomotiveCommand>& commands);

  bool empty() const { return drives_.empty(); }
  std::size_t size() const { return drives_.size(); }
  /// The index of locomotive i in the train; ascending.
  int vehicle(std::size_t i) const { return drives_[i].vehicle; }
  const TractionParams& traction(std::size_t i) const { return drives_[i].traction; }
  /// Another command, given while the others are in transmission; it reaches each group after the group's delay.
  void Command(const LocomotiveCommand& command);
  /// Sets the demand on locomotive i from the next exchange on, until the next command of the list.
  void SetCommand(std::size_t i, const NotchCommand& command) { drives_[i].command = command; }
  const NotchCommand& command(std::size_t i) const { return drives_[i].command; }  ///< that it obeys now
  const DriveState& drive(std::size_t i) const { return drives_[i].state; }

  /// Lets each locomotive begin with the notches of its group at time 0, and with their steady effort.
  void Begin(const Consist& consist, const std::vector<double>& head_velocity_mps);
  /// Advances the drives by an exchange and sets their loads: empty arrays if there are no locomotives.
  /// @param middle_s           the middle of the exchange
  /// @param head_velocity_mps  [vehicle] of the coupler heads, at the exchange's start
  void Advance(double middle_s, double interval_s, const std::vector<double>& head_velocity_mps, LoadArrays& loads);

  /// Marks the commands up to the middle of an exchange as obeyed: the restored state includes them.
  void PassBy(double middle_s);

  /// Energy that the locomotives have drawn from tank and line since the start [J]; see PowerTaken.
  double EnergyTaken() const;
  bool TellsEnergy() const;  ///< whether one of them has an energy supply
  double FuelMass() const;   ///< of those that burn fuel [kg]

  /// Calls function(number) for each number that further efforts and sums depend on.
  template <class Function>
  void ForEachField(Function&& function) {
    for (Drive& drive : drives_) {
      function(drive.command.throttle_notch);
      function(drive.command.dynamic_brake_notch);
      function(drive.state.effort_n);
      function(drive.state.side);
      function(drive.state.at_zero_s);
      function(drive.energy_taken_j);
    }
  }

 private:
  /// A command when it arrives at a locomotive.
  struct Order {
    double time_s;
    NotchCommand command;
  };
  struct Drive {
    int vehicle;
    TractionParams traction;
    double driven_weight_n;
    double command_delay_s;
    NotchCommand command;
    DriveState state;
    std::vector<Order> orders;  ///< by time
    double energy_taken_j = 0.0;
    std::size_t obeyed = 0;  ///< orders whose time has come
  };

  int vehicles_;  ///< of the train
  std::vector<Drive> drives_;
};

}  // namespace train_dynamics
