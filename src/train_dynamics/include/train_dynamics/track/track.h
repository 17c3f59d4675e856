#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/contact/polach.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/track/dip.h"
#include "train_dynamics/track/friction_map.h"
#include "train_dynamics/track/grade.h"
#include "train_dynamics/track/pieces.h"
#include "train_dynamics/track/route.h"
#include "train_dynamics/track/step_function.h"

namespace train_dynamics {

/// The track as a configuration describes it, by position along it [m].
struct TrackParams {
  static constexpr const char* kTableKey = "points";  ///< a track may be a table of them

  std::string name;
  std::vector<GradeParams> grades;
  std::vector<DipParams> dips;
  std::vector<FrictionPatchParams> friction_patches;
  std::vector<CurveParams> curves;
  std::vector<HeightParams> heights;
  std::vector<SpeedLimitParams> speed_limits;
  std::vector<StationParams> stations;
  std::vector<RoutePointParams> points;
  std::optional<double> begin_m, end_m;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the track, for people");
    v.List("grades", grades, "stretches of constant grade; none: level");
    v.List("dips", dips, "dips and humps of the rail; those that overlap add up");
    v.List("friction_patches", friction_patches,
           "stretches with a rail surface of their own; where two overlap, the later entry holds");
    v.List("curves", curves, "curves of constant radius; none: straight");
    v.List("heights", heights, "heights of the rail, in place of grades");
    v.List("speed_limits", speed_limits, "speeds that are allowed");
    v.List("stations", stations, "named places");
    v.List("points", points,
           "table of the route, a row for each position, in place of those lists above that it gives; may be "
           "a CSV file");
    v.Number("begin_m", begin_m, kFinite,
             "where the route begins to be known; default: the first of points, or without bound");
    v.Number("end_m", end_m, kFinite,
             "where the route ends to be known; default: the last of points, or without bound");
    v.Check(!begin_m || !end_m || *begin_m < *end_m, "end_m", "must be greater than begin_m", {"begin_m"});
    Check(BrokenRules(), v);
  }

  // What the lists or the points give, whichever it is, by rising position.
  std::vector<StepValue> Grades() const;             ///< [-], uphill positive
  std::vector<StepValue> Curvatures() const;         ///< [1/m], to the right positive; 0 behind each curve
  std::vector<StepValue> SpeedLimits() const;        ///< [m/s]
  std::vector<FrictionPatchParams> Patches() const;  ///< in the order in which they hold
  std::vector<StationParams> Stations() const;       ///< by rising position
  Stretch Extent() const;                            ///< where the route is known; infinite where nothing says so

 private:
  std::vector<BrokenRule> BrokenRules() const;
  void JudgeOrder(std::vector<BrokenRule>& broken) const;
  void JudgeHeights(std::vector<BrokenRule>& broken) const;
  void JudgePoints(std::vector<BrokenRule>& broken) const;
  void JudgeDips(std::vector<BrokenRule>& broken) const;
  void JudgeRamps(std::vector<BrokenRule>& broken) const;
};

/// The track prepared for look-ups by position; constant, except for patches that are added.
///
/// Each quantity has pieces of its own (track/pieces.h) and a value for each. Vehicles side by side share one look-up
/// while they are on the same piece. A surface that changes while the train runs (water, cleaning, sand) has its place
/// in SurfaceFrom and SurfaceAt: they give mu0 and the rest for a position, and need only be given the state of its
/// cell.
class Track {
 public:
  /// Not explicit: a track is its parameters.
  /// @throws std::invalid_argument when the parameters violate their rules
  Track(const TrackParams& params = {});

  /// Adds patches on top of the existing ones. None of their ends may lie within a ramp: IsWithinRamp.
  void AddPatches(const std::vector<FrictionPatchParams>& patches);

  bool has_dips = false;
  bool has_patches = false;
  bool has_curves = false;
  /// Whether the rail has no dips and, everywhere, the vehicles' own surface.
  bool IsPlain() const { return !has_dips && !has_patches; }

  const StepFunction& grades() const { return grades_; }              ///< [-], rise over run
  const StepFunction& curvatures() const { return curvatures_; }      ///< [1/m], to the right positive
  const StepFunction& speed_limits() const { return speed_limits_; }  ///< [m/s], infinite where there is none

  /// The stretch around a position that no dip touches; an empty one within a dip.
  Stretch FlatFrom(double position_m) const;
  RailHeight<double> HeightAt(double position_m) const;
  void HeightsAt(int count, const double* position_m, double* height, double* slope) const;

  /// A surface that does not change, and where it holds: an empty stretch within a ramp.
  struct SurfaceStretch {
    Stretch on;
    double friction;                 ///< mu0
    const AdhesionParams* adhesion;  ///< holds A, B, kA, kS
  };
  SurfaceStretch SurfaceFrom(double position_m, const AdhesionParams& vehicle) const;
  AdhesionParams SurfaceAt(double position_m, const AdhesionParams& vehicle) const;
  /// @param values  [5][count] mu0, A, B, kA, kS
  /// @return what holds A, B, kA, kS at all positions, or null when they differ
  const AdhesionParams* SurfacesAt(int count, const double* position_m, const AdhesionParams& vehicle,
                                   double* values) const;

 private:
  /// The surface of a piece of track: one patch, or a ramp between two. Indices of patches; -1: the vehicle's own
  /// surface.
  struct SurfacePiece {
    int before, behind;
  };

  void SetDips();
  void SetPatches();
  AdhesionParams SurfaceOf(int patch, const AdhesionParams& vehicle) const;
  const AdhesionParams* ShapeOf(const SurfacePiece& piece, const AdhesionParams& vehicle) const;

  StepFunction grades_, curvatures_, speed_limits_;
  std::vector<DipParams> dips_;
  Pieces dip_pieces_;
  /// [piece] the number of entries of dips_by_piece_ before its own; one more at the end.
  std::vector<int> dips_before_;
  std::vector<int> dips_by_piece_;  ///< indices of the dips that touch a piece, ascending
  std::vector<FrictionPatchParams> patches_;
  Pieces surface_pieces_;
  std::vector<SurfacePiece> surfaces_;  ///< [piece]
};

/// Whether a patch of the track has a ramp there, where no other one may begin or end.
bool IsWithinRamp(const TrackParams& track, double position_m);

/// Grade [-], rise over run, uphill positive: the longitudinal force on a vehicle is -m g grade.
double GradeAt(const Track& track, double position_m);

/// Curvature 1/R [1/m] of the track, to the right positive as positions rise, 0 where it is straight.
double CurvatureAt(const Track& track, double position_m);

/// The lowest speed [m/s] that is allowed anywhere under a train; infinite where there is no limit.
double SpeedLimitUnder(const Track& track, double rear_m, double front_m);

/// Height and slope of the rail under a wheel, from the dips.
RailHeight<double> RailHeightAt(const Track& track, double position_m);

/// The rail's surface under a wheel, or under several side by side.
template <class T>
struct RailSurface {
  T friction;                      ///< mu0 [-]
  const AdhesionParams* adhesion;  ///< holds A, B, kA and kS for all lanes; null: they are in `by_lane`
  CreepShape<T> by_lane;
};

/// What the creep law takes from a surface beside mu0, lane by lane.
template <class T>
CreepShape<T> ShapeOf(const RailSurface<T>& surface) {
  if (surface.adhesion == nullptr) return surface.by_lane;
  const AdhesionParams& p = *surface.adhesion;
  return {T(p.friction_ratio), T(p.friction_decay_s_per_m), T(p.adhesion_reduction), T(p.slip_reduction)};
}

template <class T>
double FirstLane(const T& x) {
  if constexpr (kLanesOf<T> == 1) {
    return static_cast<double>(x);
  } else {
    return x[0];
  }
}

/// Whether all lanes are on a stretch.
template <class T>
bool AllOn(const Stretch& stretch, const T& position_m) {
  return AllOf((position_m >= T(stretch.from_m)) & (position_m < T(stretch.to_m)));
}

/// A quantity that is constant in steps, for one vehicle or for several side by side.
template <class T>
T ValueUnder(const StepFunction& steps, const T& position_m) {
  if (steps.IsConstant()) return T(steps.First());
  const StepFunction::Held first = steps.From(FirstLane(position_m));
  if (AllOn(first.on, position_m)) return T(first.value);
  constexpr int kLanes = kLanesOf<T>;
  double at[kLanes], value[kLanes];
  Store(position_m, at);
  steps.At(kLanes, at, value);
  return Load<T>(value);
}

/// GradeAt for one vehicle or for several side by side.
template <class T>
T GradeUnder(const Track& track, const T& position_m) {
  return ValueUnder(track.grades(), position_m);
}

/// CurvatureAt for one vehicle or for several side by side.
template <class T>
T CurvatureUnder(const Track& track, const T& position_m) {
  if (!track.has_curves) return T(0.0);
  return ValueUnder(track.curvatures(), position_m);
}

/// RailHeightAt for one wheel, or for several side by side.
template <class T>
RailHeight<T> RailHeightUnder(const Track& track, const T& position_m) {
  if (!track.has_dips || AllOn(track.FlatFrom(FirstLane(position_m)), position_m)) return {T(0.0), T(0.0)};
  constexpr int kLanes = kLanesOf<T>;
  double at[kLanes], height[kLanes], slope[kLanes];
  Store(position_m, at);
  track.HeightsAt(kLanes, at, height, slope);
  return {Load<T>(height), Load<T>(slope)};
}

/// The same surface under all wheels of a vehicle, and of those side by side.
struct OneSurface {
  double friction;                 ///< mu0 [-]
  const AdhesionParams* adhesion;  ///< holds A, B, kA and kS
};

/// The surface outside of every patch: the vehicle's own.
/// @tparam T only distinguishes the instances of kernels
/// @param vehicle  must outlive what is returned
template <class T>
OneSurface OwnSurface(const AdhesionParams& vehicle) {
  return {vehicle.friction_coefficient, &vehicle};
}

/// That surface, as it is under one wheel of each lane.
template <class T>
RailSurface<T> Under(const OneSurface& one) {
  RailSurface<T> surface;
  surface.friction = T(one.friction);
  surface.adhesion = one.adhesion;
  return surface;
}

/// The surface under one wheel of a vehicle, or under those of several equal vehicles side by side.
/// @param vehicle  the vehicle's own surface, outside of every patch; must outlive what is returned
template <class T>
RailSurface<T> RailSurfaceUnder(const Track& track, const T& position_m, const AdhesionParams& vehicle) {
  RailSurface<T> surface = Under<T>(OwnSurface<T>(vehicle));
  if (!track.has_patches) return surface;
  const Track::SurfaceStretch first = track.SurfaceFrom(FirstLane(position_m), vehicle);
  if (AllOn(first.on, position_m)) {
    surface.friction = T(first.friction);
    surface.adhesion = first.adhesion;
    return surface;
  }
  constexpr int kLanes = kLanesOf<T>;
  double at[kLanes], values[5 * kLanes];
  Store(position_m, at);
  surface.adhesion = track.SurfacesAt(kLanes, at, vehicle, values);
  surface.friction = Load<T>(values);
  surface.by_lane = {Load<T>(values + kLanes), Load<T>(values + 2 * kLanes), Load<T>(values + 3 * kLanes),
                     Load<T>(values + 4 * kLanes)};
  return surface;
}

}  // namespace train_dynamics
