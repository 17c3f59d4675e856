#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// How fast the effort of a locomotive follows its controller.
struct DriveParams {
  double rise_rate_n_per_s = 40e3;
  double fall_rate_n_per_s = 100e3;
  double changeover_s = 10.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("rise_rate_n_per_s", rise_rate_n_per_s, kPositive, "largest growth of the effort's size [A]");
    v.Number("fall_rate_n_per_s", fall_rate_n_per_s, kPositive, "largest fall of the effort's size [A]");
    v.Number("changeover_s", changeover_s, kNonNegative, "time without effort between traction and dynamic brake [A]");
  }
};

/// The effort of a locomotive at a time, and what it remembers of the efforts before.
struct DriveState {
  double effort_n = 0.0;   ///< at the rims: traction positive, dynamic brake negative
  double side = 0.0;       ///< of the last effort: 1 traction, -1 dynamic brake; 0: there was none
  double at_zero_s = 0.0;  ///< for how long the effort has been 0 since
};

/// Moves a drive on by a time step:
///
///   |dF/dt| <= rise rate where the size of F grows, fall rate where it falls;
///   F keeps its sign: to change it F goes to 0 and stays there for the change-over time
///
/// The first effort of a run does not wait.
///
/// @param wanted_n  the effort that the controller asks for: traction positive, dynamic brake negative [N]
/// @param dt        the time step [s]
void StepDrive(const DriveParams& p, double wanted_n, double dt, DriveState& state);

}  // namespace train_dynamics
