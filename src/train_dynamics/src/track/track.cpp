#include "train_dynamics/track/track.h"

#include <algorithm>

#include "train_dynamics/numeric/trigonometry.h"

namespace train_dynamics {

bool TrackParams::GradesAscend() const {
  return std::adjacent_find(grades.begin(), grades.end(), [](const GradeParams& a, const GradeParams& b) {
           return a.from_m >= b.from_m;
         }) == grades.end();
}

double GradeAt(const TrackParams& track, double position_m) {
  if (track.grades.empty()) return 0.0;
  const auto next = std::upper_bound(track.grades.begin(), track.grades.end(), position_m,
                                     [](double x, const GradeParams& g) { return x < g.from_m; });
  return 0.01 * (next == track.grades.begin() ? next : next - 1)->grade_percent;
}

RailHeight DipHeight(const DipParams& dip, double position_m) {
  const double x = position_m - dip.from_m;
  if (!(x > 0.0 && x < dip.length_m)) return {0.0, 0.0};
  constexpr double kPi = 3.14159265358979323846;
  const SinCos phase = SinCosTurns(x / dip.length_m);
  return {-0.5 * dip.depth_m * (1.0 - phase.cos), -kPi * dip.depth_m / dip.length_m * phase.sin};
}

RailHeight RailHeightAt(const TrackParams& track, double position_m) {
  RailHeight sum{0.0, 0.0};
  for (const DipParams& dip : track.dips) {
    const RailHeight one = DipHeight(dip, position_m);
    sum.height += one.height;
    sum.slope += one.slope;
  }
  return sum;
}

double FrictionAt(const TrackParams& track, double position_m, double vehicle_friction) {
  double friction = vehicle_friction;
  for (const FrictionPatchParams& patch : track.friction_patches) {
    if (position_m >= patch.from_m && position_m < patch.to_m) friction = patch.friction_coefficient;
  }
  return friction;
}

}  // namespace train_dynamics
