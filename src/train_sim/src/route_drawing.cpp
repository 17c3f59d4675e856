#include "train_sim/route_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace train_sim {
namespace {

using train_dynamics::FrictionPatchParams;
using train_dynamics::StationParams;
using train_dynamics::StepValue;
using train_dynamics::Stretch;
using train_dynamics::TrackParams;

// The colours of the report.
constexpr const char *kInk = "#1b1f24", *kMuted = "#59636e", *kGrid = "#d8dde3", *kBlue = "#0072b2",
                     *kVermillion = "#d55e00", *kGreen = "#009e73", *kPurple = "#cc79a7";
constexpr double kLeft = 90.0, kWidth = 1080.0, kPanelHeight = 120.0, kGap = 26.0, kTop = 96.0;
constexpr double kRight = kLeft + kWidth;
constexpr int kMostPoints = 4000;  ///< drawn of a line

struct Point {
  double x, y;
};

/// A number without superfluous digits.
std::string Short(double value) { return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value); }

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// 1, 2 or 5 times a power of ten, so that a range has some `parts` of it.
double TickStep(double range, int parts) {
  const double raw = std::max(range, 1e-9) / parts, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10.0 * power;
}

/// A line that is constant between positions, with its corners.
std::vector<Point> Staircase(const std::vector<StepValue>& steps, const Stretch& on, double scale) {
  std::vector<Point> line;
  double value = steps.front().value;
  for (const StepValue& step : steps) {
    if (step.from_m <= on.from_m) value = step.value;
  }
  line.push_back({on.from_m, scale * value});
  for (const StepValue& step : steps) {
    if (step.from_m <= on.from_m || step.from_m >= on.to_m) continue;
    line.push_back({step.from_m, line.back().y});
    line.push_back({step.from_m, scale * step.value});
  }
  line.push_back({on.to_m, line.back().y});
  return line;
}

/// Of a long line the lowest and the highest point of each of many equal parts, in their order.
std::vector<Point> Thinned(const std::vector<Point>& line) {
  if (line.size() <= kMostPoints) return line;
  const std::size_t part = (4 * line.size() + kMostPoints - 1) / kMostPoints;
  std::vector<Point> thin;
  for (std::size_t begin = 0; begin < line.size(); begin += part) {
    const auto first = line.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = line.begin() + static_cast<std::ptrdiff_t>(std::min(begin + part, line.size()));
    auto [low, high] = std::minmax_element(first, last, [](const Point& a, const Point& b) { return a.y < b.y; });
    if (high < low) std::swap(low, high);
    for (const Point& point : {*first, *low, *high, *(last - 1)}) thin.push_back(point);
  }
  return thin;
}

/// A drawing with panels below each other over one axis of positions.
class Sheet {
 public:
  explicit Sheet(const Stretch& shown) : shown_(shown) {}

  double X(double position_m) const {
    return kLeft + kWidth * (position_m - shown_.from_m) / (shown_.to_m - shown_.from_m);
  }

  void Text(double x, double y, const std::string& text, const char* anchor, const char* colour, int size,
            const char* more = "") {
    body_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{}"{}>{}</text>)", x, y,
                         anchor, colour, size, more, Escaped(text)) +
             "\n";
  }

  void Line(double x1, double y1, double x2, double y2, const char* colour, double width, const char* more = "") {
    body_ += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{}"{}/>)",
                         x1, y1, x2, y2, colour, width, more) +
             "\n";
  }

  void Panel(const std::string& title, const std::vector<Point>& line, const char* colour, bool with_zero) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& point : line) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
    if (with_zero) {
      low = std::min(low, 0.0);
      high = std::max(high, 0.0);
    }
    if (high - low < 1e-9) {
      const double room = std::max(1.0, 0.1 * std::abs(high));
      low -= with_zero && low == 0.0 ? 0.0 : room;
      high += room;
    }
    const double step = TickStep(high - low, 4);
    low = step * std::floor(low / step + 1e-9);
    high = step * std::ceil(high / step - 1e-9);
    const double bottom = next_ + kPanelHeight;
    const auto y = [&](double value) { return bottom - kPanelHeight * (value - low) / (high - low); };
    for (double tick = low; tick <= high + 1e-6 * step; tick += step) {
      Line(kLeft, y(tick), kRight, y(tick), kGrid, 0.8);
      Text(kLeft - 8.0, y(tick) + 4.0, Short(std::round(tick / step) * step), "end", kInk, 12);
    }
    VerticalLines(bottom);
    std::string path;
    for (const Point& point : Thinned(line)) path += fmt::format("{:.2f},{:.2f} ", X(point.x), y(point.y));
    body_ += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.8"/>)", path, colour) + "\n";
    Text(kLeft, next_ - 7.0, title, "start", kInk, 13);
    next_ = bottom + kGap;
  }

  void Stations(const std::vector<StationParams>& stations) {
    double free_from = -1e9;
    for (const StationParams& station : stations) {
      const double x = X(station.position_m);
      if (x < kLeft - 0.5 || x > kRight + 0.5) continue;
      Line(x, kTop - 22.0, x, next_ - kGap, kMuted, 0.7, R"( stroke-dasharray="3 3")");
      if (x < free_from) continue;  // no room for its name
      Text(x, kTop - 27.0, station.name, "start", kMuted, 11,
           fmt::format(R"x( transform="rotate(-35 {:.1f} {:.1f})")x", x, kTop - 27.0).c_str());
      free_from = x + 14.0;
    }
  }

  std::string Svg(const std::string& title) {
    const double bottom = next_ - kGap;
    for (const double tick : Ticks()) Text(X(tick), bottom + 17.0, Short(0.001 * tick), "middle", kInk, 12);
    Text(0.5 * (kLeft + kRight), bottom + 36.0, "position [km]", "middle", kInk, 13);
    Text(12.0, 20.0, title, "start", kInk, 15, R"( font-weight="bold")");
    return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" )"
                       R"(height="{1:.0f}" font-family="DejaVu Sans, Verdana, Arial, sans-serif">)"
                       "\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{2}</svg>\n",
                       kRight + 40.0, bottom + 48.0, body_);
  }

 private:
  std::vector<double> Ticks() const {
    const double step = TickStep(shown_.to_m - shown_.from_m, 10);
    std::vector<double> ticks;
    for (double tick = step * std::ceil(shown_.from_m / step - 1e-9); tick <= shown_.to_m + 1e-6 * step; tick += step)
      ticks.push_back(tick);
    return ticks;
  }
  void VerticalLines(double bottom) {
    for (const double tick : Ticks()) Line(X(tick), bottom - kPanelHeight, X(tick), bottom, kGrid, 0.8);
  }

  Stretch shown_;
  std::string body_;
  double next_ = kTop;
};

std::vector<StepValue> FrictionOf(const std::vector<FrictionPatchParams>& patches) {
  // Where no patch is, the vehicles' own friction holds: shown as a gap at 0.
  std::vector<double> ends;
  for (const FrictionPatchParams& patch : patches) {
    ends.push_back(patch.from_m);
    ends.push_back(patch.to_m);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<StepValue> steps{{-std::numeric_limits<double>::max(), 0.0}};
  for (const double end : ends) {
    double friction = 0.0;
    for (const FrictionPatchParams& patch : patches) {
      if (end < patch.from_m || end >= patch.to_m) continue;
      friction = patch.friction_coefficient ? *patch.friction_coefficient : patch.adhesion->friction_coefficient;
    }
    steps.push_back({end, friction});
  }
  return steps;
}

}  // namespace

Stretch DrawnExtent(const TrackParams& route) {
  Stretch extent = route.Extent();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto take = [&](double position_m) {
    low = std::min(low, position_m);
    high = std::max(high, position_m);
  };
  for (const auto& grade : route.grades) take(grade.from_m);
  for (const auto& height : route.heights) take(height.position_m);
  for (const auto& limit : route.speed_limits) take(limit.from_m);
  for (const auto& station : route.stations) take(station.position_m);
  for (const auto& curve : route.curves) take(curve.from_m), take(curve.to_m);
  for (const auto& dip : route.dips) take(dip.from_m), take(dip.from_m + dip.length_m);
  for (const auto& patch : route.friction_patches) take(patch.from_m), take(patch.to_m);
  if (!(low <= high)) low = high = 0.0;
  const double room = std::max(100.0, 0.05 * (high - low));
  if (std::isinf(extent.from_m)) extent.from_m = std::min(low, extent.to_m) - room;
  if (std::isinf(extent.to_m)) extent.to_m = std::max(high, extent.from_m) + room;
  if (extent.to_m <= extent.from_m) extent.to_m = extent.from_m + room;
  return extent;
}

RouteHeight::RouteHeight(const TrackParams& route, double begin_m) : grades_(route.Grades()) {
  for (std::size_t i = 0; i < grades_.size(); ++i) {
    height_m_.push_back(i == 0 ? 0.0
                               : height_m_.back() + grades_[i - 1].value * (grades_[i].from_m - grades_[i - 1].from_m));
  }
  double known_m = 0.0, at_m = begin_m;
  if (!route.heights.empty()) {
    at_m = route.heights.front().position_m;
    known_m = route.heights.front().height_m;
  }
  for (const auto& point : route.points) {
    if (!point.height_m) continue;
    at_m = point.Position();
    known_m = *point.height_m;
    break;
  }
  shift_m_ = known_m - (*this)(at_m);
}

double RouteHeight::operator()(double position_m) const {
  if (grades_.empty()) return shift_m_;
  const auto next = std::upper_bound(grades_.begin(), grades_.end(), position_m,
                                     [](double s, const StepValue& grade) { return s < grade.from_m; });
  const std::size_t i = next == grades_.begin() ? 0 : static_cast<std::size_t>(next - grades_.begin() - 1);
  return shift_m_ + height_m_[i] + grades_[i].value * (position_m - grades_[i].from_m);
}

std::string DrawRoute(const TrackParams& route) {
  const Stretch shown = DrawnExtent(route);
  Sheet sheet(shown);
  const std::vector<StepValue> grades = route.Grades();
  const RouteHeight height(route, shown.from_m);
  std::vector<Point> heights{{shown.from_m, height(shown.from_m)}};
  for (const StepValue& grade : grades) {
    if (grade.from_m > shown.from_m && grade.from_m < shown.to_m)
      heights.push_back({grade.from_m, height(grade.from_m)});
  }
  heights.push_back({shown.to_m, height(shown.to_m)});
  sheet.Panel("height [m]", heights, kInk, false);
  if (!grades.empty()) sheet.Panel("grade [‰], uphill positive", Staircase(grades, shown, 1e3), kBlue, true);
  const std::vector<StepValue> curvatures = route.Curvatures();
  if (!curvatures.empty())
    sheet.Panel("curvature [1/km], to the right positive", Staircase(curvatures, shown, 1e3), kVermillion, true);
  const std::vector<StepValue> limits = route.SpeedLimits();
  if (!limits.empty()) sheet.Panel("speed limit [km/h]", Staircase(limits, shown, 3.6), kGreen, true);
  const std::vector<FrictionPatchParams> patches = route.Patches();
  if (!patches.empty())
    sheet.Panel("friction coefficient of the rail [-]; 0: the vehicles' own",
                Staircase(FrictionOf(patches), shown, 1.0), kPurple, true);
  sheet.Stations(route.Stations());
  return sheet.Svg(route.name.empty() ? "route" : route.name);
}

}  // namespace train_sim
