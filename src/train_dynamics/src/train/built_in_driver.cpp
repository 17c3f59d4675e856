#include "train_dynamics/train/built_in_driver.h"

#include <algorithm>
#include <cmath>

#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

constexpr double kStandingMps = 0.02;
constexpr double kSpeedStepMps = 10.0 / 3.6;
constexpr int kSpeeds = 13;
constexpr int kShareSeconds = 60;
constexpr double kReadyShare = 0.7;         // of the step to the next notch, at which it is taken
constexpr double kBrakeShare = 0.25;        // of the first reduction's force that must be lacking, or too much
constexpr double kStopDeceleration = 0.08;  // [m/s2] that the last application before a stop must give at least
constexpr double kLargestDemand = 0.5;      // [m/s2]

double Interpolate(const std::vector<double>& values, double at) {
  const double last = static_cast<double>(values.size() - 1);
  const double x = std::clamp(at, 0.0, last);
  const std::size_t i = static_cast<std::size_t>(std::min(x, last - 1.0));
  return values[i] + (x - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

double ReductionFor(const BuiltInDriverParams& p, const DriversTrain& train, double force_n, double speed_mps) {
  double reduction_kpa = p.first_reduction_kpa;
  while (reduction_kpa < p.largest_reduction_kpa && train.BrakeForce(p, reduction_kpa, speed_mps) < force_n)
    reduction_kpa += p.reduction_step_kpa;
  return std::min(reduction_kpa, p.largest_reduction_kpa);
}

/// Gathers commands and keeps the state that goes with them.
struct Hands {
  const DriversTrain& train;
  double time_s;
  BuiltInDriverState& state;
  std::vector<DriverCommand> commands;

  void Lever(int to) {
    const int from = static_cast<int>(state.lever);
    if (to == from) return;
    if (std::abs(to) > std::abs(from)) state.lever_s = time_s;
    state.lever = to;
    DriverCommand command;
    command.kind = to < 0 || (to == 0 && from < 0) ? DriverCommandKind::kDynamicBrake : DriverCommandKind::kThrottle;
    command.notch = std::abs(to);
    if (command.kind == DriverCommandKind::kDynamicBrake) command.vehicles = train.dynamic_brakes;
    commands.push_back(command);
  }
  void Apply(double reduction_kpa) {
    DriverCommand command;
    command.kind = DriverCommandKind::kApply;
    command.reduction_kpa = reduction_kpa;
    commands.push_back(command);
    state.handle_s = time_s;
  }
  void Release() {
    DriverCommand command;
    command.kind = DriverCommandKind::kRelease;
    commands.push_back(command);
    state.handle_s = state.released_s = time_s;
  }
};

void MoveLever(const BuiltInDriverParams& p, const DriversTrain& train, double force_n, double speed_mps, bool may_pull,
               Hands& hands) {
  const int at = static_cast<int>(hands.state.lever);
  const int highest = may_pull ? train.throttle_notches : 0;
  if (at > highest) return hands.Lever(std::max(highest, at - 1));
  const double now_n = train.Effort(at, speed_mps);
  const bool has_waited = hands.time_s - hands.state.lever_s >= p.notch_time_s;
  if (at < highest && (at < 0 || has_waited) &&
      force_n > now_n + kReadyShare * (train.Effort(at + 1, speed_mps) - now_n))
    return hands.Lever(at + 1);
  if (at > -train.dynamic_brake_notches && (at > 0 || has_waited) &&
      force_n < now_n - kReadyShare * (now_n - train.Effort(at - 1, speed_mps)))
    hands.Lever(at - 1);
}

/// Time until an application has half of its force [s].
double AnswerTime(const DriversTrain& train) {
  int second = 0;
  while (second < kShareSeconds && train.application_share[second] < 0.5) ++second;
  return second;
}

/// @param lacking_n  now, beside the dynamic brake
/// @param gain_mps   that the speed would have made when an application answers
void MoveHandle(const BuiltInDriverParams& p, const DriversTrain& train, double lacking_n, double gain_mps,
                const SpeedGoal& goal, const DriverView& view, Hands& hands) {
  const double v = std::abs(view.speed_mps);
  const double first_n = train.BrakeForce(p, p.first_reduction_kpa, v), now_kpa = view.reduction_kpa;
  const double since_s = hands.time_s - hands.state.handle_s;
  if (now_kpa == 0.0) {
    const bool recharged = hands.time_s - hands.state.released_s >= p.recharge_time_s;
    const double soon_n = lacking_n + train.moving_mass_kg * gain_mps / p.response_time_s;
    if (soon_n < kBrakeShare * first_n || (!recharged && v + gain_mps < goal.speed_mps + 0.25)) return;
    const double deeper_kpa = recharged ? 0.0 : p.reduction_step_kpa;
    return hands.Apply(std::min(p.largest_reduction_kpa, ReductionFor(p, train, lacking_n, v) + deeper_kpa));
  }
  const double now_n = train.BrakeForce(p, now_kpa, v);
  const double next_kpa = std::min(p.largest_reduction_kpa, now_kpa + p.reduction_step_kpa);
  if (next_kpa > now_kpa && since_s > 10.0 && lacking_n > now_n + 0.5 * (train.BrakeForce(p, next_kpa, v) - now_n))
    return hands.Apply(std::max(next_kpa, ReductionFor(p, train, lacking_n, v)));
  if (since_s < 10.0) return;
  if (!train.graduated_release || now_kpa <= p.first_reduction_kpa) {
    if (lacking_n < -kBrakeShare * first_n && view.speed_mps < goal.speed_mps - 0.3) hands.Release();
    return;
  }
  const double lower_kpa = std::max(p.first_reduction_kpa, now_kpa - p.reduction_step_kpa);
  if (lacking_n < now_n - 1.25 * (now_n - train.BrakeForce(p, lower_kpa, v))) hands.Apply(lower_kpa);
}

/// Advances the driver's estimate of the shoes' force by a step.
void FeelBrake(const BuiltInDriverParams& p, const DriversTrain& train, const DriverView& view,
               BuiltInDriverState& state) {
  const double full_n = train.BrakeForce(p, view.reduction_kpa, std::abs(view.speed_mps));
  if (full_n > state.air_n) {
    const double share = train.ApplicationShare(view.time_s - state.handle_s);
    const double before = train.ApplicationShare(view.time_s - state.handle_s - p.period_s);
    state.air_n += (full_n - state.air_n) * (share - before) / std::max(1e-3, 1.0 - before);
  } else {
    state.air_n += (full_n - state.air_n) * std::min(1.0, p.period_s / train.release_time_s);
  }
}

}  // namespace

double DriversTrain::Effort(int lever, double speed_mps) const {
  double sum_n = 0.0;
  NotchCommand command;
  (lever > 0 ? command.throttle_notch : command.dynamic_brake_notch) = std::abs(lever);
  if (lever == 0) return 0.0;
  for (const Locomotives& some : locomotives) {
    if (lever < 0 && !some.traction.dynamic_brake) continue;
    sum_n += some.count * WantedEffort(some.traction, command, speed_mps, some.driven_weight_n);
  }
  return sum_n;
}

double DriversTrain::BrakeForce(const BuiltInDriverParams& p, double reduction_kpa, double speed_mps) const {
  if (reduction_kpa <= 0.0) return 0.0;
  const double first_n = Interpolate(first_brake_n, speed_mps / kSpeedStepMps);
  const double largest_n = Interpolate(largest_brake_n, speed_mps / kSpeedStepMps);
  if (p.largest_reduction_kpa == p.first_reduction_kpa) return first_n;
  const double share =
      std::clamp((reduction_kpa - p.first_reduction_kpa) / (p.largest_reduction_kpa - p.first_reduction_kpa), 0.0, 1.0);
  return first_n + share * (largest_n - first_n);
}

double DriversTrain::ApplicationShare(double time_s) const { return Interpolate(application_share, time_s); }

DriversTrain MakeDriversTrain(const BuiltInDriverParams& p, const BrakeSystemParams& brake, const Consist& consist) {
  DriversTrain train;
  std::vector<int> count(consist.vehicle_types.size(), 0);
  std::vector<double> length_m;
  for (int i = 0; i < consist.vehicles(); ++i) {
    ++count[consist.vehicle_type[i]];
    length_m.push_back(consist.vehicle(i).length_m);
  }
  bool all_brake = true;
  for (std::size_t type = 0; type < count.size(); ++type) {
    const VehicleParams& vehicle = consist.vehicle_types[type];
    train.mass_kg += count[type] * vehicle.TotalMass();
    train.moving_mass_kg += count[type] * (vehicle.TotalMass() + EquivalentRotationalMass(vehicle));
    if (!vehicle.traction) continue;
    const TractionParams& traction = *vehicle.traction;
    const auto least = [](int& notches, int of_this) { notches = notches == 0 ? of_this : std::min(notches, of_this); };
    least(train.throttle_notches, traction.tractive_effort.throttle.Notches());
    if (traction.dynamic_brake) least(train.dynamic_brake_notches, traction.dynamic_brake->Notches());
    all_brake = all_brake && traction.dynamic_brake;
    train.locomotives.push_back({traction, vehicle.DrivenWeight(), count[type]});
  }
  for (int i = 0; !all_brake && i < consist.vehicles(); ++i) {
    if (consist.vehicle(i).traction && consist.vehicle(i).traction->dynamic_brake)
      train.dynamic_brakes.push_back(i + 1);
  }
  train.graduated_release = brake.ReleasesGradually();
  constexpr double kSettleSeconds = 120.0;
  const auto force_of = [&](const std::vector<double>& pressure_pa, double speed_mps) {
    double force_n = 0.0;
    for (int i = 0; i < consist.vehicles(); ++i)
      force_n += ShoeForce(consist.vehicle(i).Rigging(), pressure_pa[i], speed_mps) -
                 ShoeForce(consist.vehicle(i).Rigging(), 0.0, speed_mps);
    return force_n;
  };
  for (const bool is_first : {true, false}) {
    const double reduction_kpa = is_first ? p.first_reduction_kpa : p.largest_reduction_kpa;
    std::vector<BrakeCommand> commands = {{0.0, BrakeCommandKind::kApply, reduction_kpa}};
    if (is_first) commands.push_back({kSettleSeconds, BrakeCommandKind::kRelease, 0.0});
    BrakeSystem system(brake, commands, consist.centre_m, PressureGrid{0.5, 2}, length_m);
    std::vector<double> pressure_pa, force_n;
    for (int second = 0; second <= static_cast<int>(kSettleSeconds); ++second) {
      system.PressuresAt(second, pressure_pa);
      force_n.push_back(force_of(pressure_pa, 10.0));
    }
    std::vector<double>& over_speed = is_first ? train.first_brake_n : train.largest_brake_n;
    for (int i = 0; i < kSpeeds; ++i) over_speed.push_back(force_of(pressure_pa, i * kSpeedStepMps));
    if (!is_first) break;
    const double all_n = std::max(1.0, force_n.back());
    for (int second = 0; second <= kShareSeconds; ++second)
      train.application_share.push_back(second == kShareSeconds ? 1.0 : force_n[second] / all_n);
    int second = static_cast<int>(kSettleSeconds);
    for (; second < static_cast<int>(kSettleSeconds) + 120 && force_n.back() > 0.37 * all_n; ++second) {
      system.PressuresAt(second + 1, pressure_pa);
      force_n.push_back(force_of(pressure_pa, 10.0));
    }
    train.release_time_s = std::max(1.0, second - kSettleSeconds);
  }
  return train;
}

SpeedGoal GoalAt(const BuiltInDriverParams& p, const DriverView& view, const std::optional<double>& stop_m,
                 double lead_s) {
  const double margin_mps = p.limit_margin_kmh / 3.6, b = p.deceleration_mps2;
  const double lead_m = std::max(0.0, view.speed_mps) * lead_s;
  const auto held = [&](double limit_mps) { return std::max(0.5 * limit_mps, limit_mps - margin_mps); };
  SpeedGoal goal{held(view.speed_limit_mps), 0.0};
  if (p.speed_kmh) goal.speed_mps = std::min(goal.speed_mps, *p.speed_kmh / 3.6);
  const auto approach = [&](double speed_mps, double distance_m) {
    const double way_m = std::max(0.0, distance_m - lead_m);
    const double now_mps = std::sqrt(speed_mps * speed_mps + 2.0 * b * way_m);
    if (now_mps < goal.speed_mps) goal = {now_mps, way_m > 0.0 ? -b : 0.0};
  };
  for (const PlaceAhead& limit : view.limits_ahead) approach(held(limit.value), limit.from_m - view.front_m);
  if (stop_m) approach(p.creep_speed_kmh / 3.6, *stop_m - view.position_m);
  return goal;
}

double StoppingDistance(const BuiltInDriverParams& p, const DriversTrain& train, double reduction_kpa,
                        double resistance_mps2, const DriverView& view, double air_n) {
  constexpr double kStepSeconds = 0.25;
  double v = std::max(0.0, view.speed_mps), way_m = 0.0;
  for (double t = 0.0; v > 0.0 && t < 600.0; t += kStepSeconds) {
    const double share = train.ApplicationShare(t + 0.5 * kStepSeconds);
    const double now_n = std::max(air_n, share * train.BrakeForce(p, reduction_kpa, v));
    const double force_n = now_n + train.mass_kg * (kGravity * view.mean_grade + resistance_mps2);
    const double next = std::max(0.0, v - kStepSeconds * force_n / train.moving_mass_kg);
    way_m += 0.5 * kStepSeconds * (v + next);
    v = next;
  }
  return way_m;
}

std::vector<double> StopPositions(const BuiltInDriverParams& p, const TrackParams& track) {
  std::vector<double> positions_m;
  for (const StopParams& stop : p.stops) {
    double position_m = stop.position_m.value_or(0.0);
    for (const StationParams& station : track.Stations()) {
      if (!stop.position_m && station.name == stop.station) position_m = station.position_m;
    }
    positions_m.push_back(position_m);
  }
  return positions_m;
}

std::vector<DriverCommand> Drive(const BuiltInDriverParams& p, const DriversTrain& train,
                                 const std::vector<double>& stops_m, const DriverView& view,
                                 BuiltInDriverState& state) {
  Hands hands{train, view.time_s, state, {}};
  FeelBrake(p, train, view, state);
  if (view.emergency) {
    hands.Lever(0);
    return hands.commands;
  }
  const double v = view.speed_mps;
  const bool has_stop = state.stop < static_cast<double>(stops_m.size());
  const std::size_t at = static_cast<std::size_t>(state.stop);
  if (state.is_stopping != 0.0) {
    hands.Lever(0);
    if (v < kStandingMps && state.standing_s < 0.0) {
      state.standing_s = view.time_s;
      if (view.reduction_kpa < p.largest_reduction_kpa) hands.Apply(p.largest_reduction_kpa);
    }
    const bool goes_on = state.standing_s >= 0.0 && state.stop + 1.0 < static_cast<double>(stops_m.size()) &&
                         view.time_s >= state.standing_s + p.stops[at].dwell_s;
    if (!goes_on) return hands.commands;
    state.stop += 1.0;
    state.is_stopping = 0.0;
    state.standing_s = -1.0;
    hands.Release();
    return hands.commands;
  }
  const std::optional<double> stop_m = has_stop ? std::optional<double>(stops_m[at]) : std::nullopt;
  if (stop_m && v < 1.5 * p.creep_speed_kmh / 3.6 && v > 0.0) {
    const double wanted_n = train.mass_kg * (kStopDeceleration - kGravity * std::min(0.0, view.mean_grade));
    const double reduction_kpa = std::max(view.reduction_kpa, ReductionFor(p, train, wanted_n, v));
    if (StoppingDistance(p, train, reduction_kpa, state.resistance_mps2, view, state.air_n) >=
        *stop_m - view.position_m) {
      state.is_stopping = 1.0;
      hands.Lever(0);
      if (reduction_kpa > view.reduction_kpa) hands.Apply(reduction_kpa);
      return hands.commands;
    }
  }
  constexpr double kLeadSeconds = 15.0;
  const SpeedGoal goal = GoalAt(p, view, stop_m, kLeadSeconds);
  const double missing_mps = goal.speed_mps - v;
  // The planned deceleration applies near the goal speed: a slow train need not brake yet.
  const double planned_mps2 = goal.acceleration_mps2 * std::clamp(2.0 * v / goal.speed_mps - 1.0, 0.0, 1.0);
  const double demand = std::clamp(planned_mps2 + missing_mps / p.response_time_s, -kLargestDemand, kLargestDemand);
  const double force_n =
      train.moving_mass_kg * demand + train.mass_kg * (kGravity * view.mean_grade + state.resistance_mps2);
  const int lever = static_cast<int>(state.lever);
  const bool is_within = lever < train.throttle_notches && lever > -train.dynamic_brake_notches;
  if (goal.acceleration_mps2 == 0.0 && std::abs(missing_mps) < 1.0 && is_within) {
    state.resistance_mps2 = std::clamp(
        state.resistance_mps2 + p.period_s * missing_mps / (4.0 * p.response_time_s * p.response_time_s), -0.03, 0.05);
  }
  const double first_n = train.BrakeForce(p, p.first_reduction_kpa, std::abs(v));
  const bool is_released = view.reduction_kpa == 0.0 && state.air_n < 0.2 * first_n;
  const bool may_pull = is_released || (view.reduction_kpa == 0.0 && view.mean_grade > 0.0);
  MoveLever(p, train, force_n + state.air_n, std::abs(v), may_pull, hands);
  const double dynamic_n = -train.Effort(-train.dynamic_brake_notches, std::abs(v));
  if (state.lever > 0.0) return hands.commands;
  const double lacking_n = -force_n - dynamic_n;
  // The speed predicted for then, with the dynamic brake alone, needs more force.
  const double downhill_n = -train.mass_kg * (kGravity * view.mean_grade + state.resistance_mps2);
  const double gain_mps =
      std::max(0.0, downhill_n - dynamic_n - state.air_n) / train.moving_mass_kg * AnswerTime(train);
  MoveHandle(p, train, lacking_n, gain_mps, goal, view, hands);
  return hands.commands;
}

}  // namespace train_dynamics
