#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "train_dynamics/numeric/linear_table.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

enum class CurvingResistanceLaw {
  kCole,    ///< 6116 / R [M] (Cole, Handbook of Railway Vehicle Dynamics, ch. 9, 2006); 0.714 lb/short ton/degree
  kArea,    ///< 6850.5 / R [S]; 0.8 lb/short ton/degree, one degree (chord of 100 ft) being R = 1746.40 m
  kRoeckl,  ///< g 650 / (R - 55) from R = 300 m on, g 500 / (R - 30) below [M]; not continuous at 300 m, as published
  kTable
};

/// Resistance over the radius of curves, linear between points; above the last radius it falls as 1/R, below the first
/// it stays.
struct CurvingTableParams {
  std::vector<double> radius_m;
  std::vector<double> resistance_n_per_t;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("radius_m", radius_m, kPositive,
              "radii of the table, ascending; beyond the last one the resistance falls as 1/R");
    v.Numbers("resistance_n_per_t", resistance_n_per_t, kNonNegative, "resistance at each of them, not ascending");
    v.Check(!radius_m.empty(), "radius_m", "must list the radii of the table");
    v.Check(IsAscending(radius_m), "radius_m", "must ascend");
    v.Check(resistance_n_per_t.size() == radius_m.size(), "resistance_n_per_t", "must have as many values as radius_m",
            {"radius_m"});
    v.Check(std::is_sorted(resistance_n_per_t.rbegin(), resistance_n_per_t.rend()), "resistance_n_per_t",
            "must not ascend");
  }
};

/// The law of a vehicle's resistance in curves.
struct CurvingResistanceParams {
  CurvingResistanceLaw law = CurvingResistanceLaw::kCole;
  CurvingTableParams table;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law,
             {{"cole", CurvingResistanceLaw::kCole},
              {"area", CurvingResistanceLaw::kArea},
              {"roeckl", CurvingResistanceLaw::kRoeckl},
              {"table", CurvingResistanceLaw::kTable}},
             "cole: 6116 / R newtons per tonne [M]; area, roeckl: see the equations; table: measured");
    if (law == CurvingResistanceLaw::kTable) v.Group("table", table, "measured resistance over radius");
  }
};

/// Resistance of a curve [N] per tonne of the vehicle's mass, >= 0; it opposes the motion and is set-valued at rest.
///
/// Left out: speed, cant, the kind of bogie (a factor of 2 between bogies is usual), the transition at a curve's ends.
///
/// @param curvature_per_m  1/R, of either sign; 0 on straight track. |R| >= 50 m
double CurvingResistance(const CurvingResistanceParams& p, double curvature_per_m);

}  // namespace train_dynamics
