#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "train_dynamics/numeric/linear_table.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// The energy that a locomotive draws from its tank or its line for the power at the rims.
struct EnergySupplyParams {
  std::vector<double> power_share = {1.0};
  std::vector<double> efficiency = {0.35};
  double idle_power_w = 0.0;
  double recovered_share = 0.0;
  std::optional<double> fuel_energy_j_per_kg;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("power_share", power_share, kFraction,
              "shares of the rim power P at which efficiency is given, ascending");
    v.Numbers("efficiency", efficiency, Range{0.0, 1.0, true, false},
              "at these: power at the rims over power taken [A]");
    v.Check(!power_share.empty(), "power_share", "must list at least one share");
    v.Check(IsAscending(power_share), "power_share", "must ascend");
    v.Check(efficiency.size() == power_share.size(), "efficiency", "must have as many values as power_share",
            {"power_share"});
    v.Number("idle_power_w", idle_power_w, kNonNegative, "power taken in addition at all times");
    v.Number("recovered_share", recovered_share, kFraction, "share of the dynamic brake's power that is fed back");
    v.Number("fuel_energy_j_per_kg", fuel_energy_j_per_kg, kPositive,
             "lower heating value of the fuel (diesel 42.7e6); not given: electric");
    v.Check(!fuel_energy_j_per_kg || recovered_share == 0.0, "recovered_share",
            "must be 0 where fuel_energy_j_per_kg is given: no fuel is fed back", {"fuel_energy_j_per_kg"});
  }
};

/// Power taken from tank or line [W]; negative where more is fed back than is taken:
///
///   P_taken = P_idle + P_r / eta(P_r / P)           for P_r >= 0, eta linear between points of the table
///   P_taken = P_idle + recovered_share P_r          for P_r < 0
///
/// @param rim_power_w   P_r, effort x speed at the rims: traction positive, dynamic brake negative
/// @param full_power_w  P, > 0
inline double PowerTaken(const EnergySupplyParams& p, double rim_power_w, double full_power_w) {
  if (rim_power_w < 0.0) return p.idle_power_w + p.recovered_share * rim_power_w;
  const double share = Min(1.0, rim_power_w / full_power_w);
  return p.idle_power_w + rim_power_w / InterpolateLinearly(p.power_share, p.efficiency, share);
}

}  // namespace train_dynamics
