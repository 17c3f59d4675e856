#include "train_sim/route_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <set>
#include <stdexcept>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_run/exit_code.h"
#include "train_sim/route_drawing.h"

namespace train_sim {
namespace {

using train_dynamics::StationParams;
using train_dynamics::StepValue;
using train_dynamics::Stretch;
using train_dynamics::Track;
using train_dynamics::TrackParams;

constexpr double kPerMille = 1e3, kKmPerM = 1e-3, kKmhPerMps = 3.6, kDegrees = 57.295779513082323;
constexpr double kSteep = 0.04;          ///< few railways without racks are steeper
constexpr double kTight = 150.0;         ///< [m] few main lines have such curves
constexpr double kLargestChange = 0.03;  ///< of the grade at one place

template <class... Values>
void Line(const char* name, const char* format, const Values&... values) {
  train_console::Print("  {:<10} {}\n", name, fmt::format(fmt::runtime(format), values...));
}

/// One stretch of a staircase within the drawn extent.
struct Tread {
  double from_m, to_m, value;
};

std::vector<Tread> TreadsOf(const std::vector<StepValue>& steps, const Stretch& on) {
  std::vector<Tread> treads;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double from_m = i == 0 ? on.from_m : std::max(on.from_m, steps[i].from_m);
    const double to_m = i + 1 < steps.size() ? std::min(on.to_m, steps[i + 1].from_m) : on.to_m;
    if (from_m >= to_m) continue;
    if (!treads.empty() && treads.back().value == steps[i].value) {
      treads.back().to_m = to_m;  // a row that changes nothing
    } else {
      treads.push_back({from_m, to_m, steps[i].value});
    }
  }
  return treads;
}

std::string Km(double position_m) { return fmt::format("{:.3f} km", kKmPerM * position_m); }

void PrintGrades(const TrackParams& route, const Stretch& extent) {
  const std::vector<Tread> treads = TreadsOf(route.Grades(), extent);
  if (treads.empty()) return Line("grades", "level");
  const auto by_value = [](const Tread& a, const Tread& b) { return a.value < b.value; };
  const auto [fall, rise] = std::minmax_element(treads.begin(), treads.end(), by_value);
  double climbed = 0.0, descended = 0.0;
  for (const Tread& tread : treads) {
    const double up = tread.value * (tread.to_m - tread.from_m);
    (up > 0.0 ? climbed : descended) += std::abs(up);
  }
  Line("grades", "{} stretches, {:+.3g} ‰ (from {}) to {:+.3g} ‰ (from {}); up {:.1f} m, down {:.1f} m in all",
       treads.size(), kPerMille * fall->value, Km(fall->from_m), kPerMille * rise->value, Km(rise->from_m), climbed,
       descended);
}

void PrintCurves(const TrackParams& route, const Stretch& extent) {
  std::vector<Tread> curves;
  double length_m = 0.0, angle = 0.0;
  for (const Tread& tread : TreadsOf(route.Curvatures(), extent)) {
    if (tread.value == 0.0) continue;
    curves.push_back(tread);
    length_m += tread.to_m - tread.from_m;
    angle += std::abs(tread.value) * (tread.to_m - tread.from_m);
  }
  if (curves.empty()) return Line("curves", "none");
  const auto tightest = std::max_element(curves.begin(), curves.end(), [](const Tread& a, const Tread& b) {
    return std::abs(a.value) < std::abs(b.value);
  });
  Line("curves", "{}, {:.3f} km of them, {:.0f} degrees in all; the tightest has {:.0f} m radius to the {} (from {})",
       curves.size(), kKmPerM * length_m, kDegrees * angle, 1.0 / std::abs(tightest->value),
       tightest->value > 0.0 ? "right" : "left", Km(tightest->from_m));
}

void PrintLimits(const TrackParams& route, const Stretch& extent) {
  const std::vector<Tread> treads = TreadsOf(route.SpeedLimits(), extent);
  if (treads.empty()) return Line("limits", "none");
  const auto [low, high] = std::minmax_element(treads.begin(), treads.end(),
                                               [](const Tread& a, const Tread& b) { return a.value < b.value; });
  double time_s = 0.0;
  for (const Tread& tread : treads) time_s += (tread.to_m - tread.from_m) / tread.value;
  Line("limits", "{} stretches, {:g} km/h (from {}) to {:g} km/h; at the limit all along: {:.1f} min", treads.size(),
       kKmhPerMps * low->value, Km(low->from_m), kKmhPerMps * high->value, time_s / 60.0);
}

std::vector<std::string> WarningsAbout(const TrackParams& route, const Stretch& extent) {
  std::vector<std::string> warnings;
  const std::vector<Tread> grades = TreadsOf(route.Grades(), extent);
  for (std::size_t i = 0; i < grades.size(); ++i) {
    if (std::abs(grades[i].value) > kSteep)
      warnings.push_back(fmt::format("a grade of {:+.3g} ‰ at {}: steeper than railways without racks are",
                                     kPerMille * grades[i].value, Km(grades[i].from_m)));
    if (i > 0 && std::abs(grades[i].value - grades[i - 1].value) > kLargestChange)
      warnings.push_back(fmt::format("the grade changes by {:+.3g} ‰ at {}, at one place",
                                     kPerMille * (grades[i].value - grades[i - 1].value), Km(grades[i].from_m)));
  }
  for (const Tread& curve : TreadsOf(route.Curvatures(), extent)) {
    if (std::abs(curve.value) > 1.0 / kTight)
      warnings.push_back(fmt::format("a radius of {:.0f} m at {}: tighter than main lines have it",
                                     1.0 / std::abs(curve.value), Km(curve.from_m)));
  }
  for (const StationParams& station : route.Stations()) {
    if (station.position_m < extent.from_m || station.position_m > extent.to_m)
      warnings.push_back(fmt::format("{} at {} lies outside of the route", station.name, Km(station.position_m)));
  }
  return warnings;
}

void WriteFile(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file + " could not be written");
}

std::string QuotedIfNeeded(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// A row wherever something changes; with all values in each row, so that it reads back to the same route.
std::string Table(const TrackParams& route, const Stretch& extent) {
  const Track track(route);
  std::set<double> positions{extent.from_m, extent.to_m};
  for (const auto& steps : {route.Grades(), route.Curvatures(), route.SpeedLimits()}) {
    for (const StepValue& step : steps) positions.insert(step.from_m);
  }
  const std::vector<StationParams> stations = route.Stations();
  for (const StationParams& station : stations) positions.insert(station.position_m);
  const bool has_limits = !route.SpeedLimits().empty();
  std::string text =
      std::string("position_m,station,grade_permille,radius_m") + (has_limits ? ",speed_limit_kmh\n" : "\n");
  for (auto at = positions.lower_bound(extent.from_m); at != positions.end() && *at <= extent.to_m; ++at) {
    const auto station =
        std::find_if(stations.begin(), stations.end(), [&](const StationParams& s) { return s.position_m == *at; });
    const double curvature = CurvatureAt(track, *at);
    text += fmt::format("{},{},{:.9g},{:.9g}", *at, station == stations.end() ? "" : QuotedIfNeeded(station->name),
                        kPerMille * GradeAt(track, *at), curvature == 0.0 ? 0.0 : 1.0 / curvature);
    if (has_limits) text += fmt::format(",{:.9g}", kKmhPerMps * track.speed_limits().At(*at));
    text += "\n";
  }
  return text;
}

}  // namespace

int ShowRoute(const RouteOptions& options) {
  const TrackParams route = train_dynamics::config::LoadTrack(options.file, options.overrides);
  const Stretch extent = DrawnExtent(route);
  train_console::Print("{}\n", route.name.empty() ? options.file : route.name);
  Line("extent", "{} to {}, {:.3f} km{}", Km(extent.from_m), Km(extent.to_m), kKmPerM * (extent.to_m - extent.from_m),
       std::isinf(route.Extent().to_m) ? " (of its entries; the route has no end)" : "");
  const RouteHeight height(route, extent.from_m);
  Line("height", "{:.1f} m at its begin, {:.1f} m at its end", height(extent.from_m), height(extent.to_m));
  PrintGrades(route, extent);
  PrintCurves(route, extent);
  PrintLimits(route, extent);
  if (!route.dips.empty()) Line("dips", "{}", route.dips.size());
  if (!route.Patches().empty()) Line("friction", "{} patches", route.Patches().size());
  const std::vector<StationParams> stations = route.Stations();
  if (!stations.empty()) {
    std::string names;
    for (std::size_t i = 0; i < stations.size() && i < 12; ++i)
      names += fmt::format("{}{} at {}", i == 0 ? "" : ", ", stations[i].name, Km(stations[i].position_m));
    Line("stations", "{}{}", names, stations.size() > 12 ? fmt::format(" and {} more", stations.size() - 12) : "");
  }
  constexpr std::size_t kShown = 20;
  const std::vector<std::string> warnings = WarningsAbout(route, extent);
  std::fflush(stdout);
  for (std::size_t i = 0; i < warnings.size() && i < kShown; ++i) train_console::Tell("warning: {}\n", warnings[i]);
  if (warnings.size() > kShown) train_console::Tell("and {} warnings more\n", warnings.size() - kShown);
  if (!options.plot.empty()) WriteFile(options.plot, DrawRoute(route));
  if (!options.csv.empty()) WriteFile(options.csv, Table(route, extent));
  return train_run::kSuccess;
}

}  // namespace train_sim
