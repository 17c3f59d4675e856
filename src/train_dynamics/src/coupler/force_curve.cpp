#include "train_dynamics/coupler/force_curve.h"

namespace train_dynamics {

double ForceCurveParams::At(double at_m) const {
  const auto next = std::upper_bound(travel_m.begin(), travel_m.end(), at_m);
  if (next == travel_m.begin()) return force_n.front();
  if (next == travel_m.end()) return force_n.back();
  const auto i = static_cast<std::size_t>(next - travel_m.begin());
  return force_n[i - 1] + (force_n[i] - force_n[i - 1]) * (at_m - travel_m[i - 1]) / (travel_m[i] - travel_m[i - 1]);
}

double ForceCurveParams::SteepestSlope() const {
  double steepest = 0.0;
  for (std::size_t i = 1; i < std::min(travel_m.size(), force_n.size()); ++i) {
    steepest = std::max(steepest, (force_n[i] - force_n[i - 1]) / (travel_m[i] - travel_m[i - 1]));
  }
  return steepest;
}

bool HysteresisParams::UnloadsAboveLoading() const {
  for (const ForceCurveParams* curve : {&loading, &unloading}) {
    if (curve->travel_m.size() != curve->force_n.size() || curve->travel_m.empty()) return false;
  }
  // Linear between points, they cross only if one is on the wrong side at a point of either. Rounding of a table that
  // is written twice, without hysteresis, does not count.
  constexpr double kRounding = 1e-9;
  for (const ForceCurveParams* curve : {&loading, &unloading}) {
    for (const double at_m : curve->travel_m) {
      if (unloading.At(at_m) > loading.At(at_m) * (1.0 + kRounding)) return true;
    }
  }
  return false;
}

ForceCurve::ForceCurve(const ForceCurveParams& params)
    : segments(static_cast<int>(params.travel_m.size()) - 1), begin_m{}, begin_n{}, length_m{}, slope_n_per_m{} {
  for (int i = 0; i <= segments; ++i) {
    begin_m[i] = params.travel_m[i];
    begin_n[i] = params.force_n[i];
    if (i == segments) break;
    length_m[i] = params.travel_m[i + 1] - params.travel_m[i];
    slope_n_per_m[i] = (params.force_n[i + 1] - params.force_n[i]) / length_m[i];
  }
}

}  // namespace train_dynamics
