#pragma once

#include <string>
#include <vector>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/track/friction_map.h"
#include "train_dynamics/track/grade.h"
#include "train_dynamics/track/profile.h"

namespace train_dynamics {

/// The track as functions of the position along it [m].
struct TrackParams {
  std::string name;
  std::vector<GradeParams> grades;                    ///< empty = level
  std::vector<DipParams> dips;                        ///< overlapping dips add up
  std::vector<FrictionPatchParams> friction_patches;  ///< where two overlap, the later entry holds

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name);
    v.List("grades", grades);
    v.List("dips", dips);
    v.List("friction_patches", friction_patches);
    v.Check(GradesAscend(), "grades", "must ascend in from_m");
  }

 private:
  bool GradesAscend() const;
};

/// Grade [-], rise over run, uphill positive: the longitudinal force on a vehicle is -m g grade.
double GradeAt(const TrackParams& track, double position_m);

/// Height and slope of the rail under a wheel, from the dips.
RailHeight RailHeightAt(const TrackParams& track, double position_m);

/// mu0 under a wheel: that of the patch, or the vehicle's own outside of every patch.
double FrictionAt(const TrackParams& track, double position_m, double vehicle_friction);

/// What a wheel meets at its position: rail height [m], slope [-] and mu0 [-].
template <class T>
struct RailPoint {
  T height, slope, friction;
};

/// GradeAt for one vehicle or for several side by side.
template <class T>
T GradeUnder(const TrackParams& track, T position_m) {
  if (track.grades.empty()) return T(0.0);
  if (track.grades.size() == 1) return T(0.01 * track.grades.front().grade_percent);
  return MapLanes([&track](double x) { return GradeAt(track, x); }, position_m);
}

/// The rail under one wheel, or under several side by side.
template <class T>
RailPoint<T> RailUnder(const TrackParams& track, T position_m, double vehicle_friction) {
  RailPoint<T> rail{T(0.0), T(0.0), T(vehicle_friction)};
  if (!track.dips.empty()) {
    rail.height = MapLanes([&track](double x) { return RailHeightAt(track, x).height; }, position_m);
    rail.slope = MapLanes([&track](double x) { return RailHeightAt(track, x).slope; }, position_m);
  }
  if (!track.friction_patches.empty()) {
    rail.friction = MapLanes([&](double x) { return FrictionAt(track, x, vehicle_friction); }, position_m);
  }
  return rail;
}

}  // namespace train_dynamics
