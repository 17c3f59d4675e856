#pragma once

#include <cmath>
#include <vector>

#include "train_dynamics/numeric/linear_table.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"
#include "train_dynamics/traction/tractive_effort.h"

namespace train_dynamics {

/// The dynamic brake of a locomotive, whose traction motors then work as generators.
struct DynamicBrakeParams {
  double largest_effort_n = kRequired;
  double rim_power_w = kRequired;
  double fade_speed_mps = 1.0;
  std::vector<double> effort_share = {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("largest_effort_n", largest_effort_n, kPositive, "F_max, largest braking effort at the rims");
    v.Number("rim_power_w", rim_power_w, kPositive, "P_db, braking power at the rims");
    v.Number("fade_speed_mps", fade_speed_mps, kPositive,
             "v_a, below which the effort fades: 5.4 for DC [S], 1.0 for AC drives [A]");
    v.Numbers("effort_share", effort_share, kFraction, "share of the effort of each notch, from notch 1, ascending");
    v.Check(!effort_share.empty(), "effort_share", "must list the share of each notch");
    v.Check(IsAscending(effort_share), "effort_share", "must ascend from notch to notch");
  }

  int Notches() const { return static_cast<int>(effort_share.size()); }
};

/// Effort at the rims that the dynamic brake gives [N], >= 0; it opposes the motion and vanishes at rest:
///
///   F = d_n min( F_max min(1, |v| / v_a),  P_db / max(|v|, 0.1 m/s) )
///
/// Wheel-rail adhesion limits it in the 2D model, by the creep forces, and where the vehicle's adhesion limit is on.
///
/// @param notch      0 ... the number of notches, linear between them; beyond, the highest holds
/// @param speed_mps  v, of the locomotive; the effort is even in it
inline double DynamicBrakeEffort(const DynamicBrakeParams& p, double notch, double speed_mps) {
  const double v = std::abs(speed_mps);
  const double by_field_n = p.largest_effort_n * Min(1.0, v / p.fade_speed_mps);
  return NotchShare(p.effort_share, notch) * Min(by_field_n, p.rim_power_w / Max(v, kLeastPowerSpeed));
}

}  // namespace train_dynamics
