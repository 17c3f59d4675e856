#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/numeric/linear_table.h"
#include "train_dynamics/parameters.h"
#include "train_dynamics/traction/usable_adhesion.h"

namespace train_dynamics {

/// The share of the full effort or power that each notch of a controller gives.
///
/// A notch need not be whole: shares are linear between notches, from 0 at notch 0, as those of a locomotive without
/// steps.
double NotchShare(const std::vector<double>& shares, double notch);

/// The steps of a throttle.
struct ThrottleParams {
  std::vector<double> effort_share = {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0};
  std::vector<double> power_share = {0.0444, 0.1109, 0.2306, 0.3438, 0.4923, 0.6520, 0.8117, 1.0};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("effort_share", effort_share, kFraction,
              "share of the starting effort of each notch, from notch 1, ascending: n / 8 (Cole, Handbook of "
              "Railway Vehicle Dynamics, ch. 9, 2006) [M]");
    v.Numbers("power_share", power_share, kFraction,
              "share of the power of each notch: a C44-9W's, read off its display (A. Krug, Railroad Facts) [S]");
    v.Check(!effort_share.empty(), "effort_share", "must list the share of each notch");
    v.Check(IsAscending(effort_share), "effort_share", "must ascend from notch to notch");
    v.Check(power_share.size() == effort_share.size(), "power_share", "must have as many values as effort_share",
            {"effort_share"});
    v.Check(IsAscending(power_share), "power_share", "must ascend from notch to notch");
  }

  int Notches() const { return static_cast<int>(effort_share.size()); }
};

/// Effort over speed, linear between points; beyond the last point its effort falls as 1/v.
struct EffortTableParams {
  std::vector<double> speed_kmh;
  std::vector<double> effort_n;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("speed_kmh", speed_kmh, kNonNegative,
              "speeds of the table, ascending; beyond the last one the effort falls as 1/v");
    v.Numbers("effort_n", effort_n, kPositive, "effort at each of them, not ascending");
    v.Check(!speed_kmh.empty(), "speed_kmh", "must list the speeds of the table");
    v.Check(IsAscending(speed_kmh), "speed_kmh", "must ascend");
    v.Check(effort_n.size() == speed_kmh.size(), "effort_n", "must have as many values as speed_kmh", {"speed_kmh"});
    v.Check(std::is_sorted(effort_n.rbegin(), effort_n.rend()), "effort_n", "must not ascend");
  }

  /// The effort [N] at a speed >= 0 [m/s].
  double At(double speed_mps) const;
  /// The largest power of its points and of the lines between them [W].
  double LargestPower() const;
};

/// The tractive effort of a locomotive at the rims of its driven wheels.
struct TractiveEffortParams {
  double starting_effort_n = kRequired;
  double rim_power_w = kRequired;
  ThrottleParams throttle;
  std::optional<EffortTableParams> table;
  UsableAdhesionParams usable_adhesion;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("starting_effort_n", starting_effort_n, kPositive, "F_start, effort at the rims at the highest notch");
    v.Number("rim_power_w", rim_power_w, kPositive,
             "P, power at the rims: 0.93 of the engine's with AC, 0.85 with DC drives [S]");
    v.Group("throttle", throttle, "shares of effort and power of each notch");
    v.Group("table", table, "measured effort of the highest notch over speed; not given: min(F_start, P / v)");
    v.Group("usable_adhesion", usable_adhesion, "adhesion that the control makes use of, which limits the effort");
  }
};

/// The least speed by which a power is divided [m/s]: below it, power sets no limit that matters.
inline constexpr double kLeastPowerSpeed = 0.1;

/// Effort at the rims that a throttle asks for [N], >= 0:
///
///   F = min( f_n F_start,  p_n P / max(|v|, 0.1 m/s),  mu(v) W,  table(|v|) )
///
/// It is that of the steady state: a drive takes time to reach it (traction/drive.h). The table is that of the highest
/// notch; below, the shares of effort and power hold.
///
/// @param notch            0 ... the number of notches; beyond, the highest holds
/// @param speed_mps        v, of the locomotive; the effort is even in it
/// @param driven_weight_n  W, on the driven wheels, > 0
double TractiveEffort(const TractiveEffortParams& p, double notch, double speed_mps, double driven_weight_n);

}  // namespace train_dynamics
