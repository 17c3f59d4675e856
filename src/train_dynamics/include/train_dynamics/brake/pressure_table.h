#pragma once

#include <stdexcept>
#include <vector>

#include "train_dynamics/brake/brake_command.h"

namespace train_dynamics {

/// Cylinder pressures as time series, one per vehicle: measured, or saved from another run (the paper's
/// section 4.1).
///
/// Linear between the rows; before the first and after the last row, that row.
class PressureTable {
 public:
  /// @param time_s        ascending, at least one
  /// @param pressure_pa   [vehicle][row]
  /// @throws std::invalid_argument if times do not ascend, a column's length differs or a pressure is
  /// negative
  PressureTable(std::vector<double> time_s, std::vector<std::vector<double>> pressure_pa);

  int vehicles() const { return static_cast<int>(pressure_pa_.size()); }

  /// Cylinder pressure of each vehicle [Pa] at a time; resizes `pressure_pa`.
  void PressuresAt(double time_s, std::vector<double>& pressure_pa) const;

  /// @throws std::invalid_argument  measured pressures obey no driver
  void Command(const BrakeCommand& /*command*/) {
    throw std::invalid_argument("the pressures come from pressure_table: they obey no command");
  }
  /// Measured pressures do not answer.
  void OpenPipe(double /*time_s*/, int /*connection*/) {}

  /// There is no state.
  template <class Function>
  void ForEachField(Function&& /*field*/) {}

 private:
  std::vector<double> time_s_;
  std::vector<std::vector<double>> pressure_pa_;
};

}  // namespace train_dynamics
