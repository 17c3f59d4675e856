#include "train_dynamics/train/driver_view.h"

#include <algorithm>

namespace train_dynamics {
namespace {

/// The steps of a quantity on (from_m, to_m], by rising position; a piece with the value of the piece before it is no
/// step.
std::vector<PlaceAhead> StepsOn(const StepFunction& steps, double from_m, double to_m) {
  std::vector<PlaceAhead> ahead;
  for (StepFunction::Held held = steps.From(from_m); held.on.to_m <= to_m;) {
    const double at_m = held.on.to_m, before = held.value;
    held = steps.From(at_m);
    if (held.value != before) ahead.push_back({at_m, held.value});
  }
  return ahead;
}

}  // namespace

void SetBrakeHandle(double initial_reduction_kpa, const std::vector<DriverCommand>& commands,
                    const std::vector<GivenCommand>& given, double time_s, double exchange_interval_s,
                    DriverView& view) {
  view.reduction_kpa = initial_reduction_kpa;
  view.emergency = false;
  double newest_s = 0.0;
  const auto take = [&](const DriverCommand& command, double at_s) {
    if (!command.IsOfTrainBrake() || at_s > time_s || at_s < newest_s) return;
    newest_s = at_s;
    if (view.emergency && command.kind != DriverCommandKind::kRelease) return;
    view.emergency = command.kind == DriverCommandKind::kEmergency;
    if (command.kind == DriverCommandKind::kRelease) view.reduction_kpa = 0.0;
    if (command.kind == DriverCommandKind::kApply) view.reduction_kpa = command.reduction_kpa;
  };
  for (const DriverCommand& command : commands) {
    if (command.time_s) take(command, *command.time_s);
  }
  for (const GivenCommand& command : given)
    take(command.command, static_cast<double>(command.exchange) * exchange_interval_s);
}

RouteSight::RouteSight(const TrackParams& track, const Consist& consist, double start_position_m)
    : track_(track),
      stations_(track.Stations()),
      front_offset_m_(0.5 * consist.vehicle(0).length_m),
      rear_offset_m_(0.5 * consist.vehicle(consist.vehicles() - 1).length_m) {
  double mass_kg = 0.0;
  for (int i = 0; i < consist.vehicles(); ++i) mass_kg += consist.vehicle(i).TotalMass();
  for (int i = 0; i < consist.vehicles(); ++i) {
    start_m_.push_back(start_position_m + consist.centre_m[i]);
    mass_share_.push_back(consist.vehicle(i).TotalMass() / mass_kg);
  }
}

void RouteSight::Look(const std::vector<double>& displacement_m, double ahead_m, DriverView& view) const {
  view.position_m = start_m_.front() + displacement_m.front();
  view.front_m = view.position_m + front_offset_m_;
  view.rear_m = start_m_.back() + displacement_m.back() - rear_offset_m_;
  view.speed_limit_mps = SpeedLimitUnder(track_, view.rear_m, view.front_m);
  view.mean_grade = 0.0;
  for (std::size_t i = 0; i < start_m_.size(); ++i)
    view.mean_grade += mass_share_[i] * GradeAt(track_, start_m_[i] + displacement_m[i]);
  const double to_m = view.front_m + ahead_m;
  view.limits_ahead = StepsOn(track_.speed_limits(), view.front_m, to_m);
  view.grades_ahead = StepsOn(track_.grades(), view.front_m, to_m);
  const auto first = std::find_if(stations_.begin(), stations_.end(),
                                  [&](const StationParams& station) { return station.position_m >= view.position_m; });
  const auto end =
      std::find_if(first, stations_.end(), [&](const StationParams& station) { return station.position_m > to_m; });
  view.stations_ahead.assign(first, end);
}

}  // namespace train_dynamics
