#include "train_dynamics/resistance/curving.h"

namespace train_dynamics {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

double FromTable(const CurvingTableParams& p, double radius_m) {
  if (radius_m > p.radius_m.back()) return p.resistance_n_per_t.back() * (p.radius_m.back() / radius_m);
  return InterpolateLinearly(p.radius_m, p.resistance_n_per_t, radius_m);
}

}  // namespace

double CurvingResistance(const CurvingResistanceParams& p, double curvature_per_m) {
  if (curvature_per_m == 0.0) return 0.0;
  const double radius_m = 1.0 / std::abs(curvature_per_m);
  switch (p.law) {
    case CurvingResistanceLaw::kArea:
      return 6850.5 / radius_m;
    case CurvingResistanceLaw::kRoeckl:
      return kGravity * (radius_m >= 300.0 ? 650.0 / (radius_m - 55.0) : 500.0 / (radius_m - 30.0));
    case CurvingResistanceLaw::kTable:
      return FromTable(p.table, radius_m);
    default:
      return 6116.0 / radius_m;
  }
}

}  // namespace train_dynamics
