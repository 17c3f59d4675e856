#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "train_dynamics/parameters.h"

/// What a route has beside grades and surfaces, by position along it.
namespace train_dynamics {

/// A curve of constant radius on [from_m, to_m); the track is straight outside of all curves. Transition curves are left
/// out: the curvature steps.
struct CurveParams {
  static constexpr double kSmallestRadius =
      50.0;  ///< [m] below it the laws of curving resistance hold no longer

  double from_m = kRequired;
  double to_m = kRequired;
  double radius_m = kRequired;  ///< of the centre line; > 0 to the right, < 0 to the left, as positions rise

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite);
    v.Number("to_m", to_m, kFinite);
    v.Number("radius_m", radius_m, kFinite);
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
    v.Number("from_m", from_m, kFinite);
    v.Number("limit_kmh", limit_kmh, kPositive);
  }
};

/// A named place, such as a station or a signal.
struct StationParams {
  std::string name;
  double position_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name);
    v.Number("position_m", position_m, kFinite);
    v.Check(!name.empty(), "name", "must be given");
  }
};

/// The height of the rail at a position, in place of grades: the rail rises or falls evenly from one to the next and is
/// level outside of them.
struct HeightParams {
  double position_m = kRequired;
  double height_m = kRequired;  ///< above any fixed level

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite);
    v.Number("height_m", height_m, kFinite);
  }
};

/// All that is known of the route at one position: a row of a table. What a row leaves empty goes on as before.
struct RoutePointParams {
  std::optional<double> position_m, position_km;        ///< one of them
  std::optional<double> grade_permille, grade_percent;  ///< uphill positive, from here on
  std::optional<double> height_m;                       ///< see HeightParams
  std::optional<double> radius_m;                       ///< see CurveParams; from here on; 0: straight
  std::optional<double> speed_limit_kmh;                ///< from here on
  std::optional<double> friction_coefficient;           ///< mu0 of the rail, from here on
  std::string station;                                  ///< its name, where there is one

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite);
    v.Number("position_km", position_km, kFinite);
    v.Text("station", station);
    v.Number("grade_permille", grade_permille, Range{-200.0, 200.0, false, false});
    v.Number("grade_percent", grade_percent, Range{-20.0, 20.0, false, false});
    v.Number("height_m", height_m, kFinite);
    v.Number("radius_m", radius_m, kFinite);
    v.Number("speed_limit_kmh", speed_limit_kmh, kPositive);
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false});
    v.Check(position_m.has_value() != position_km.has_value(), "position_m",
            "or position_km must be given, one of them", {"position_km"});
    v.Check(!(grade_permille && grade_percent), "grade_permille", "must not stand beside grade_percent",
            {"grade_percent"});
    v.Check(
        !radius_m || *radius_m == 0.0 || std::abs(*radius_m) >= CurveParams::kSmallestRadius, "radius_m",
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
