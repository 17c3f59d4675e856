#pragma once

#include <vector>

#include "train_dynamics/brake/air_brake.h"

namespace train_dynamics {

/// The pressures of an air brake on a grid of times t_h = h dt, by recurrence.
///
/// Time is cut into windows of `steps` steps. At the begin of a window each cylinder's gap to its target is
/// evaluated by the law (one exponential per vehicle), from there on it is multiplied step by step:
///
///   p = target + g,  g(t + dt) = g(t) exp(-rate dt)
///
/// A window in which any vehicle's phase begins is evaluated by the law throughout. So the pressures at t_h
/// depend on h alone, whatever times were queried before, and differ from the law's by rounding only: at most `steps`
/// of half an ulp of g.
class BrakePressures {
 public:
  /// @param dt_s  step of the grid, > 0
  /// @param steps  length of a window, >= 1
  BrakePressures(AirBrake brake, double dt_s, int steps);

  /// See AirBrake. Pressures of earlier times must not be queried afterwards.
  void Command(const BrakeCommand& command);
  /// See AirBrake. Pressures of earlier times must not be queried afterwards.
  void OpenPipe(double time_s, int connection);

  /// @param time_s  rounded to the nearest time of the grid; t >= 0
  void PressuresAt(double time_s, std::vector<double>& pressure_pa);

  /// No state of its own: the pressures depend on time and on where the pipe is open, which the connections store.
  template <class Function>
  void ForEachField(Function&& /*field*/) {}

 private:
  void TakePhases();
  void BeginWindow(long window);

  AirBrake brake_;
  double dt_s_;
  int steps_;
  std::vector<double> begin_s_;  ///< of all phases, ascending
  long window_ = -1;
  bool by_law_ = false;                             ///< throughout the window
  long at_ = 0;                                     ///< step that gap_pa_ belongs to
  std::vector<double> target_pa_, gap_pa_, decay_;  ///< [vehicle], filled up to whole packs of lanes
};

}  // namespace train_dynamics
