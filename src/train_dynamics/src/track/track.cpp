#include "train_dynamics/track/track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "strict_config/validate.h"
#include "train_dynamics/numeric/trigonometry.h"

namespace train_dynamics {
namespace {

constexpr Stretch kNowhere{0.0, 0.0};
constexpr std::size_t kMostDipOverlaps = 10000000;  // 40 MB

std::string Index(std::size_t i) { return "[" + std::to_string(i) + "]"; }

/// A value that holds from one position to another, among others of its kind.
struct Span {
  double from_m, to_m;
};

/// Calls `piece(from_m, covering)` for every stretch between neighbouring ends of spans, in ascending order, the last
/// one empty; `covering` are the indices of the spans on it. Stops when it returns false.
template <class Function>
void Sweep(const std::vector<Span>& spans, const Function& piece) {
  struct End {
    double at_m;
    int span;
    bool begins;
  };
  std::vector<End> ends;
  ends.reserve(2 * spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) {
    ends.push_back({spans[i].from_m, static_cast<int>(i), true});
    ends.push_back({spans[i].to_m, static_cast<int>(i), false});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.at_m < b.at_m; });
  std::set<int> covering;
  for (auto end = ends.begin(); end != ends.end();) {
    const double at_m = end->at_m;
    for (; end != ends.end() && end->at_m == at_m; ++end) {
      if (end->begins) {
        covering.insert(end->span);
      } else {
        covering.erase(end->span);
      }
    }
    if (!piece(at_m, covering)) return;
  }
}

/// The stretch on which a dip may have an effect: a little longer than it is, because DipHeight judges its end by a
/// difference.
Span SpanOf(const DipParams& dip) {
  const double to_m = dip.from_m + dip.length_m;
  return {dip.from_m, to_m + 1e-15 * (std::abs(dip.from_m) + std::abs(to_m))};
}

std::vector<Span> SpansOf(const std::vector<DipParams>& dips) {
  std::vector<Span> spans;
  spans.reserve(dips.size());
  for (const DipParams& dip : dips) spans.push_back(SpanOf(dip));
  return spans;
}

bool AreSpans(const std::vector<FrictionPatchParams>& patches) {
  return std::all_of(patches.begin(), patches.end(), [](const FrictionPatchParams& patch) {
    return std::isfinite(patch.from_m) && std::isfinite(patch.to_m) && patch.from_m < patch.to_m &&
           patch.RampLength() >= 0.0;
  });
}

/// A place where the surface changes.
struct SurfaceChange {
  double at_m;
  int before, behind;  ///< indices of patches; -1: the vehicle's own surface
  double ramp_m;       ///< its length, half of it on each side
  int patch;           ///< whose end this is

  double Begin() const { return at_m - 0.5 * ramp_m; }
  double End() const { return at_m + 0.5 * ramp_m; }
};

std::vector<SurfaceChange> ChangesOf(const std::vector<FrictionPatchParams>& patches) {
  std::vector<Span> spans;
  spans.reserve(patches.size());
  for (const FrictionPatchParams& patch : patches) spans.push_back({patch.from_m, patch.to_m});
  std::vector<SurfaceChange> changes;
  int before = -1;
  Sweep(spans, [&](double at_m, const std::set<int>& covering) {
    const int behind = covering.empty() ? -1 : *covering.rbegin();  // the later entry holds
    if (behind == before) return true;
    SurfaceChange change{at_m, before, behind, 0.0, -1};
    const auto ends = [&](int patch) {
      change.patch = patch;
      change.ramp_m = std::max(change.ramp_m, patches[patch].RampLength());
    };
    if (before >= 0 && patches[before].to_m == at_m) ends(before);
    if (behind >= 0 && patches[behind].from_m == at_m) ends(behind);
    changes.push_back(change);
    before = behind;
    return true;
  });
  return changes;
}

}  // namespace

// ---- the rules between entries -------------------------------------------------------------------------------------

std::vector<BrokenRule> TrackParams::BrokenRules() const {
  std::vector<BrokenRule> broken;
  JudgeOrder(broken);
  JudgeHeights(broken);
  JudgePoints(broken);
  JudgeDips(broken);
  JudgeRamps(broken);
  return broken;
}

/// A rule that each position of a list must be greater than the one before.
template <class Entry, class Position, class Report>
void JudgeRising(const std::vector<Entry>& entries, const Position& position, const Report& report) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const double before_m = position(entries[i - 1]);
    if (position(entries[i]) > before_m) continue;
    report(i, "must be greater than that of the entry before, " + ShortestDecimal(before_m));
  }
}

void TrackParams::JudgeOrder(std::vector<BrokenRule>& broken) const {
  const auto judge = [&](const auto& entries, const char* list, const char* key, const auto& position) {
    JudgeRising(entries, position, [&](std::size_t i, const std::string& text) {
      broken.push_back({list + Index(i) + "." + key, text, {list + Index(i - 1) + "." + key}});
    });
  };
  judge(grades, "grades", "from_m", [](const GradeParams& grade) { return grade.from_m; });
  judge(heights, "heights", "position_m", [](const HeightParams& height) { return height.position_m; });
  judge(speed_limits, "speed_limits", "from_m", [](const SpeedLimitParams& limit) { return limit.from_m; });
  const auto position = [this](std::size_t i) {
    return "points" + Index(i) + (points[i].position_m ? ".position_m" : ".position_km");
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || points[i].Position() > points[i - 1].Position()) continue;
    broken.push_back(
        {position(i),
         "must lie behind that of the entry before, at " + ShortestDecimal(points[i - 1].Position()) + " m",
         {position(i - 1)}});
  }
  for (std::size_t i = 1; i < curves.size(); ++i) {
    if (curves[i].from_m >= curves[i - 1].to_m) continue;
    broken.push_back({"curves" + Index(i) + ".from_m",
                      "must be at least to_m of the entry before, " + ShortestDecimal(curves[i - 1].to_m),
                      {"curves" + Index(i - 1) + ".to_m"}});
  }
}

/// Grades that heights make are judged like those that are given.
void TrackParams::JudgeHeights(std::vector<BrokenRule>& broken) const {
  constexpr double kSteepest = 0.2;
  const auto judge = [&](const std::string& list, std::size_t last, const HeightParams& before, std::size_t i,
                         const HeightParams& here) {
    if (here.position_m <= before.position_m) return;  // said
    const double grade = (here.height_m - before.height_m) / (here.position_m - before.position_m);
    if (std::abs(grade) <= kSteepest) return;
    broken.push_back({list + Index(i) + ".height_m",
                      "must not make a grade steeper than 20 % from the height before, " +
                          ShortestDecimal(before.height_m) + " m at " + ShortestDecimal(before.position_m) + " m",
                      {list + Index(i), list + Index(last)}});
  };
  for (std::size_t i = 1; i < heights.size(); ++i) judge("heights", i - 1, heights[i - 1], i, heights[i]);
  std::optional<HeightParams> before;
  std::size_t last = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].height_m) continue;
    const HeightParams here{points[i].Position(), *points[i].height_m};
    if (before) judge("points", last, *before, i, here);
    before = here;
    last = i;
  }
}

/// A quantity given by the points must not be given elsewhere.
void TrackParams::JudgePoints(std::vector<BrokenRule>& broken) const {
  const auto first_with = [this](const auto& has) -> std::optional<std::size_t> {
    const auto found = std::find_if(points.begin(), points.end(), has);
    if (found == points.end()) return std::nullopt;
    return static_cast<std::size_t>(found - points.begin());
  };
  const auto judge = [&](const char* key, const auto& has, bool is_given, const char* other) {
    const std::optional<std::size_t> first = first_with(has);
    if (!first || !is_given) return;
    broken.push_back({"points" + Index(*first) + "." + key, std::string("must not stand beside ") + other, {}});
  };
  using Point = RoutePointParams;
  const auto has_grade = [](const Point& p) { return p.Grade().has_value(); };
  const auto has_height = [](const Point& p) { return p.height_m.has_value(); };
  const std::optional<std::size_t> first_grade = first_with(has_grade);
  const char* const grade_key = first_grade && points[*first_grade].grade_percent ? "grade_percent" : "grade_permille";
  judge(grade_key, has_grade, !grades.empty(), "grades");
  judge(grade_key, has_grade, !heights.empty(), "heights");
  judge("height_m", has_height, !grades.empty(), "grades");
  judge("height_m", has_height, !heights.empty(), "heights");
  judge("height_m", has_height, first_grade.has_value(), "grades of points");
  judge(
      "radius_m", [](const Point& p) { return p.radius_m.has_value(); }, !curves.empty(), "curves");
  judge(
      "speed_limit_kmh", [](const Point& p) { return p.speed_limit_kmh.has_value(); }, !speed_limits.empty(),
      "speed_limits");
  judge(
      "friction_coefficient", [](const Point& p) { return p.friction_coefficient.has_value(); },
      !friction_patches.empty(), "friction_patches");
  if (!heights.empty() && !grades.empty()) broken.push_back({"heights", "must not stand beside grades", {"grades"}});
}

void TrackParams::JudgeDips(std::vector<BrokenRule>& broken) const {
  const bool are_spans = std::all_of(
      dips.begin(), dips.end(), [](const DipParams& dip) { return std::isfinite(dip.from_m) && dip.length_m > 0.0; });
  if (!are_spans) return;
  std::size_t overlaps = 0;
  Sweep(SpansOf(dips), [&](double at_m, const std::set<int>& covering) {
    overlaps += covering.size();
    if (overlaps <= kMostDipOverlaps) return true;
    broken.push_back({"dips" + Index(*covering.rbegin()),
                      "must not overlap so many others: up to " + ShortestDecimal(at_m) +
                          " m the stretches between ends of dips lie in more than " + std::to_string(kMostDipOverlaps) +
                          " dips in all",
                      {"dips"}});
    return false;
  });
}

void TrackParams::JudgeRamps(std::vector<BrokenRule>& broken) const {
  if (!AreSpans(friction_patches)) return;
  constexpr double kRounding = 1e-9;  // [m]
  const std::vector<SurfaceChange> changes = ChangesOf(friction_patches);
  for (std::size_t i = 1; i < changes.size(); ++i) {
    const SurfaceChange &one = changes[i - 1], &next = changes[i];
    if (one.End() <= next.Begin() + kRounding) continue;
    // An existing ramp is reported before a sharp end.
    const SurfaceChange& named = next.ramp_m > 0.0 ? next : one;
    broken.push_back({"friction_patches" + Index(named.patch) + ".ramp_length_m",
                      "must leave room to the next change of the surface: half of a ramp lies on each side "
                      "of an end, and the ones "
                      "at " +
                          ShortestDecimal(one.at_m) + " m (" + ShortestDecimal(one.ramp_m) + " m long) and " +
                          ShortestDecimal(next.at_m) + " m (" + ShortestDecimal(next.ramp_m) + " m) overlap",
                      {"friction_patches[].from_m", "friction_patches[].to_m", "friction_patches[].ramp_length_m"}});
  }
}

// ---- lists or points
// -------------------------------------------------------------------------------------------------

namespace {

/// The value that each point gives from its position on.
template <class Value>
void AddSteps(const std::vector<RoutePointParams>& points, const Value& value, std::vector<StepValue>& steps) {
  for (const RoutePointParams& point : points) {
    if (const std::optional<double> here = value(point)) steps.push_back({point.Position(), *here});
  }
}

/// The grades between heights, and level track behind the last. (Before the first, the caller sets level track.)
std::vector<StepValue> GradesBetween(const std::vector<HeightParams>& heights) {
  std::vector<StepValue> steps;
  if (heights.empty()) return steps;
  // The first value of a StepFunction holds before its position as well.
  steps.push_back({heights.front().position_m - 1.0, 0.0});
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const HeightParams &here = heights[i], &next = heights[i + 1];
    steps.push_back({here.position_m, (next.height_m - here.height_m) / (next.position_m - here.position_m)});
  }
  steps.push_back({heights.back().position_m, 0.0});
  return steps;
}

}  // namespace

std::vector<StepValue> TrackParams::Grades() const {
  std::vector<StepValue> steps;
  for (const GradeParams& grade : grades) steps.push_back({grade.from_m, 0.01 * grade.grade_percent});
  AddSteps(
      points, [](const RoutePointParams& point) { return point.Grade(); }, steps);
  if (!steps.empty()) return steps;
  std::vector<HeightParams> profile = heights;
  for (const RoutePointParams& point : points) {
    if (point.height_m) profile.push_back({point.Position(), *point.height_m});
  }
  return GradesBetween(profile);
}

std::vector<StepValue> TrackParams::Curvatures() const {
  std::vector<StepValue> steps;
  if (!curves.empty()) steps.push_back({curves.front().from_m - 1.0, 0.0});
  for (const CurveParams& curve : curves) {
    if (steps.back().from_m == curve.from_m) steps.pop_back();
    steps.push_back({curve.from_m, 1.0 / curve.radius_m});
    steps.push_back({curve.to_m, 0.0});
  }
  AddSteps(
      points,
      [](const RoutePointParams& point) -> std::optional<double> {
        if (!point.radius_m) return std::nullopt;
        return *point.radius_m == 0.0 ? 0.0 : 1.0 / *point.radius_m;
      },
      steps);
  return steps;
}

std::vector<StepValue> TrackParams::SpeedLimits() const {
  std::vector<StepValue> steps;
  for (const SpeedLimitParams& limit : speed_limits) steps.push_back({limit.from_m, limit.limit_kmh / 3.6});
  AddSteps(
      points,
      [](const RoutePointParams& point) -> std::optional<double> {
        if (!point.speed_limit_kmh) return std::nullopt;
        return *point.speed_limit_kmh / 3.6;
      },
      steps);
  return steps;
}

std::vector<FrictionPatchParams> TrackParams::Patches() const {
  constexpr double kFarAway = 1e6;  // [m] beyond the reach of any train
  std::vector<FrictionPatchParams> patches = friction_patches;
  std::vector<StepValue> steps;
  AddSteps(
      points, [](const RoutePointParams& point) { return point.friction_coefficient; }, steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    FrictionPatchParams patch;
    patch.from_m = i == 0 ? steps[i].from_m - kFarAway : steps[i].from_m;
    patch.to_m = i + 1 < steps.size() ? steps[i + 1].from_m : steps[i].from_m + kFarAway;
    patch.friction_coefficient = steps[i].value;
    patches.push_back(patch);
  }
  return patches;
}

std::vector<StationParams> TrackParams::Stations() const {
  std::vector<StationParams> all = stations;
  for (const RoutePointParams& point : points) {
    if (!point.station.empty()) all.push_back({point.station, point.Position()});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const StationParams& a, const StationParams& b) { return a.position_m < b.position_m; });
  return all;
}

Stretch TrackParams::Extent() const {
  Stretch extent;
  if (!points.empty()) extent = {points.front().Position(), points.back().Position()};
  return {begin_m.value_or(extent.from_m), end_m.value_or(extent.to_m)};
}

// ---- making it ready -----------------------------------------------------------------------------------------------

Track::Track(const TrackParams& params) : has_dips(!params.dips.empty()), dips_(params.dips) {
  strict_config::Validate(params);
  grades_ = StepFunction(params.Grades(), 0.0);
  const std::vector<StepValue> curvatures = params.Curvatures();
  has_curves = !curvatures.empty();
  curvatures_ = StepFunction(curvatures, 0.0);
  speed_limits_ = StepFunction(params.SpeedLimits(), std::numeric_limits<double>::infinity());
  patches_ = params.Patches();
  has_patches = !patches_.empty();
  SetDips();
  SetPatches();
}

void Track::SetDips() {
  std::vector<double> cuts;
  dips_before_ = {0, 0};  // no dip before the first cut
  Sweep(SpansOf(dips_), [&](double at_m, const std::set<int>& covering) {
    cuts.push_back(at_m);
    dips_by_piece_.insert(dips_by_piece_.end(), covering.begin(), covering.end());
    dips_before_.push_back(static_cast<int>(dips_by_piece_.size()));
    return true;
  });
  dip_pieces_ = Pieces(std::move(cuts));
}

bool IsWithinRamp(const TrackParams& track, double position_m) {
  const std::vector<FrictionPatchParams> patches = track.Patches();
  if (!AreSpans(patches)) return false;  // another rule says so
  const std::vector<SurfaceChange> changes = ChangesOf(patches);
  return std::any_of(changes.begin(), changes.end(), [position_m](const SurfaceChange& change) {
    return change.Begin() < position_m && position_m < change.End();
  });
}

void Track::AddPatches(const std::vector<FrictionPatchParams>& patches) {
  patches_.insert(patches_.end(), patches.begin(), patches.end());
  has_patches = !patches_.empty();
  SetPatches();
}

void Track::SetPatches() {
  std::vector<double> cuts;
  surfaces_.clear();
  surfaces_.push_back({-1, -1});
  double last_m = -std::numeric_limits<double>::infinity();
  const auto cut = [&](double at_m, const SurfacePiece& piece) {
    if (at_m > last_m) {
      cuts.push_back(at_m);
      surfaces_.push_back(piece);
      last_m = at_m;
    } else {
      surfaces_.back() = piece;  // ramps from both sides have used up the piece before
    }
  };
  for (const SurfaceChange& change : ChangesOf(patches_)) {
    if (change.ramp_m > 0.0) cut(change.Begin(), {change.before, change.behind});
    cut(change.End(), {change.behind, change.behind});
  }
  surface_pieces_ = Pieces(std::move(cuts));
}

// ---- what is under a wheel -----------------------------------------------------------------------------------------

double GradeAt(const Track& track, double position_m) { return track.grades().At(position_m); }

double CurvatureAt(const Track& track, double position_m) { return track.curvatures().At(position_m); }

double SpeedLimitUnder(const Track& track, double rear_m, double front_m) {
  return track.speed_limits().SmallestOn(rear_m, front_m);
}

RailHeight<double> DipHeight(const DipParams& dip, double position_m) {
  const double x = position_m - dip.from_m;
  if (!(x > 0.0 && x < dip.length_m)) return {0.0, 0.0};
  constexpr double kPi = 3.14159265358979323846;
  const SinCos phase = SinCosTurns(x / dip.length_m);
  return {-0.5 * dip.depth_m * (1.0 - phase.cos), -kPi * dip.depth_m / dip.length_m * phase.sin};
}

Stretch Track::FlatFrom(double position_m) const {
  const int piece = dip_pieces_.NumberAt(position_m);
  return dips_before_[piece] == dips_before_[piece + 1] ? dip_pieces_[piece] : kNowhere;
}

RailHeight<double> Track::HeightAt(double position_m) const {
  const int piece = dip_pieces_.NumberAt(position_m);
  RailHeight<double> sum{0.0, 0.0};
  for (int i = dips_before_[piece]; i < dips_before_[piece + 1]; ++i) {
    const RailHeight<double> one = DipHeight(dips_[dips_by_piece_[i]], position_m);
    sum.height += one.height;
    sum.slope += one.slope;
  }
  return sum;
}

void Track::HeightsAt(int count, const double* position_m, double* height, double* slope) const {
  for (int i = 0; i < count; ++i) {
    const RailHeight<double> rail = HeightAt(position_m[i]);
    height[i] = rail.height;
    slope[i] = rail.slope;
  }
}

RailHeight<double> RailHeightAt(const Track& track, double position_m) { return track.HeightAt(position_m); }

AdhesionParams Track::SurfaceOf(int patch, const AdhesionParams& vehicle) const {
  if (patch < 0) return vehicle;
  AdhesionParams surface = patches_[patch].adhesion.value_or(vehicle);
  if (patches_[patch].friction_coefficient) surface.friction_coefficient = *patches_[patch].friction_coefficient;
  return surface;
}

const AdhesionParams* Track::ShapeOf(const SurfacePiece& piece, const AdhesionParams& vehicle) const {
  const auto shape_of = [&](int patch) {
    return patch < 0 || !patches_[patch].adhesion ? &vehicle : &*patches_[patch].adhesion;
  };
  return shape_of(piece.before) == shape_of(piece.behind) ? shape_of(piece.before) : nullptr;
}

Track::SurfaceStretch Track::SurfaceFrom(double position_m, const AdhesionParams& vehicle) const {
  const int number = surface_pieces_.NumberAt(position_m);
  const SurfacePiece& piece = surfaces_[number];
  if (piece.before != piece.behind) return {kNowhere, 0.0, nullptr};
  const AdhesionParams* const shape = ShapeOf(piece, vehicle);
  const bool has_own_friction = piece.before >= 0 && patches_[piece.before].friction_coefficient;
  return {surface_pieces_[number],
          has_own_friction ? *patches_[piece.before].friction_coefficient : shape->friction_coefficient, shape};
}

AdhesionParams Track::SurfaceAt(double position_m, const AdhesionParams& vehicle) const {
  const int number = surface_pieces_.NumberAt(position_m);
  const SurfacePiece& piece = surfaces_[number];
  AdhesionParams surface = SurfaceOf(piece.before, vehicle);
  if (piece.before == piece.behind) return surface;
  const AdhesionParams behind = SurfaceOf(piece.behind, vehicle);
  const Stretch ramp = surface_pieces_[number];
  const double share = (position_m - ramp.from_m) / (ramp.to_m - ramp.from_m);
  for (double AdhesionParams::*const field :
       {&AdhesionParams::friction_coefficient, &AdhesionParams::friction_ratio, &AdhesionParams::friction_decay_s_per_m,
        &AdhesionParams::adhesion_reduction, &AdhesionParams::slip_reduction}) {
    surface.*field += share * (behind.*field - surface.*field);
  }
  return surface;
}

const AdhesionParams* Track::SurfacesAt(int count, const double* position_m, const AdhesionParams& vehicle,
                                        double* values) const {
  const AdhesionParams* shape = nullptr;
  for (int i = 0; i < count; ++i) {
    const AdhesionParams surface = SurfaceAt(position_m[i], vehicle);
    values[i] = surface.friction_coefficient;
    values[count + i] = surface.friction_ratio;
    values[2 * count + i] = surface.friction_decay_s_per_m;
    values[3 * count + i] = surface.adhesion_reduction;
    values[4 * count + i] = surface.slip_reduction;
    const AdhesionParams* const of_this = ShapeOf(surfaces_[surface_pieces_.NumberAt(position_m[i])], vehicle);
    shape = i == 0 || shape == of_this ? of_this : nullptr;
  }
  return shape;
}

}  // namespace train_dynamics
