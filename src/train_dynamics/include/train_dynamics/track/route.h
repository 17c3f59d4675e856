#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "train_dynamics/parameters.h"

/// What a route has besides grades and surfaces, by position along it.
namespace train_dynamics {

/// A curve of constant radius on [from_m, to_m); the track is straight outside of all curves. Transition curves are
/// left out: the curvature steps.
struct CurveParams {
  static constexpr double kSmallestRadius = 50.0;  ///< [m] below it the laws of curving resistance hold no longer

  double from_m = kRequired;
  double to_m = kRequired;
  double radius_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite, "position at which the curve begins");
    v.Number("to_m", to_m, kFinite, "position at which the curve ends");
    v.Number("radius_m", radius_m, kFinite,
             "radius of the centre line, at least 50 m; > 0 to the right, < 0 to the left, as positions rise");
    v.Check(from_m < to_m, "to_m", "must be greater than from_m", {"from_m"});
    v.Check(std::abs(radius_m) >= kSmallestRadius, "radius_m",
            "must be at least 50 m, to the right (> 0) or to the left (< 0)", {"radius_m"});
  }
};

/// The speed that is allowed from `from_m` to the next entry's; the first also holds before it.
struct SpeedLimitParams {
  double from_m = kRequired;
  double limit_kmh = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite,
             "position from which the limit holds, up to the next entry's; the first also holds before it");
    v.Number("limit_kmh", limit_kmh, kPositive, "speed that is allowed");
  }
};

/// A named place, such as a station or a signal.
struct StationParams {
  std::string name;
  double position_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the place: a station, a signal");
    v.Number("position_m", position_m, kFinite, "position of the place");
    v.Check(!name.empty(), "name", "must be given");
  }
};

/// The height of the rail at a position, in place of grades: the rail rises or falls evenly from one to the next and is
/// level outside of them.
struct HeightParams {
  double position_m = kRequired;
  double height_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite, "position of the point");
    v.Number("height_m", height_m, kFinite,
             "height of the rail above any fixed level; between points it changes evenly, outside of them "
             "the track is level");
  }
};

/// All that is known of the route at one position: a row of a table. An empty entry keeps the value of the row before.
struct RoutePointParams {
  std::optional<double> position_m, position_km;
  std::optional<double> grade_permille, grade_percent;
  std::optional<double> height_m;
  std::optional<double> radius_m;
  std::optional<double> speed_limit_kmh;
  std::optional<double> friction_coefficient;
  std::string station;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite, "position of the row; or else position_km");
    v.Number("position_km", position_km, kFinite, "position of the row; or else position_m");
    v.Text("station", station, "name of the station there");
    v.Number("grade_permille", grade_permille, Range{-200.0, 200.0, false, false},
             "rise over run from here on, uphill positive; or else grade_percent");
    v.Number("grade_percent", grade_percent, Range{-20.0, 20.0, false, false},
             "rise over run from here on, uphill positive; or else grade_permille");
    v.Number("height_m", height_m, kFinite, "height of the rail above any fixed level, in place of grades");
    v.Number("radius_m", radius_m, kFinite,
             "radius of the curve from here on; > 0 to the right, < 0 to the left, 0: straight");
    v.Number("speed_limit_kmh", speed_limit_kmh, kPositive, "speed that is allowed from here on");
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false},
             "mu0 of the rail from here on");
    v.Check(position_m.has_value() != position_km.has_value(), "position_m",
            "or position_km must be given, one of them", {"position_km"});
    v.Check(!(grade_permille && grade_percent), "grade_permille", "must not stand beside grade_percent",
            {"grade_percent"});
    v.Check(!radius_m || *radius_m == 0.0 || std::abs(*radius_m) >= CurveParams::kSmallestRadius, "radius_m",
            "must be at least 50 m, to the right (> 0) or to the left (< 0), or 0 where the track is straight",
            {"radius_m"});
  }

  double Position() const { return position_m ? *position_m : 1000.0 * position_km.value_or(0.0); }  ///< [m]
  std::optional<double> Grade() const {                                                              ///< [-]
    if (grade_permille) return 0.001 * *grade_permille;
    if (grade_percent) return 0.01 * *grade_percent;
    return std::nullopt;
  }
};

}  // namespace train_dynamics
