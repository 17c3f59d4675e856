#include "train_dynamics/train/scenario.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "train_dynamics/train/built_in_driver.h"
#include "train_dynamics/train/exchange_stability.h"

namespace train_dynamics {
namespace {

/// How many parts make up a whole that is known to be a multiple.
long Parts(double whole, double part) { return std::lround(whole / part); }

std::string Index(std::size_t i) { return "[" + std::to_string(i) + "]"; }

std::string Counted(std::size_t entries) {
  return std::to_string(entries) + (entries == 1 ? " entry" : " entries");
}

/// A number for people, to five digits.
std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

/// Warns of a connection that the exchange interval or the step is too long for.
void WarnOfConnection(const ScenarioParams& scenario, const std::string& key,
                      const ConnectionParams& connection, double lightest_kg,
                      std::vector<Warning>& warnings) {
  const ConnectionLaw law = connection.Law();
  const bool depends_on_force =
      std::visit([](const auto& of) { return of.TangentAt(kLargeCouplerForce).depends_on_force; }, law);
  const double longest_s = LongestStableExchange(connection, LightestCouplerHead(scenario));
  // A multiple of dt_s may exceed the limit by no more than a rounding error.
  if (scenario.exchange_interval_s > (1.0 + 1e-9) * longest_s) {
    warnings.push_back({"exchange_interval_s", "exchange_interval_s " + Short(scenario.exchange_interval_s) +
                                                   " is above " + Short(longest_s) + ", the longest that " +
                                                   key + " stands" + (depends_on_force ? " at 900 kN" : "") +
                                                   ": coupler forces may break down; take a shorter one"});
  }
  const auto* smooth = std::get_if<SmoothGears>(&law);
  if (smooth == nullptr) return;
  const std::string speed_key = key + ".draft_gear.smoothing_speed_mps";
  const double speed_mps = smooth->params.smoothing_speed_mps;
  const double lowest_mps = smooth->LeastSmoothingSpeed(kLargeCouplerForce, scenario.dt_s, lightest_kg);
  if (speed_mps >= lowest_mps) return;
  warnings.push_back(
      {speed_key, speed_key + " " + Short(speed_mps) + " is below " + Short(lowest_mps) +
                      ", the least for dt_s " + Short(scenario.dt_s) + " at 900 kN and " +
                      Short(lightest_kg) +
                      " kg: the friction of the draft gears may chatter; take a smaller dt_s"});
}

/// The positions that wheels can have in a run at most.
///
/// Nothing but the grade and traction drives a train: its speed stays below that of the start plus T times the largest
/// acceleration that they can give, and likewise backwards, where traction does not drive.
Stretch ReachOf(const ScenarioParams& scenario) {
  double steepest_fall = 0.0, steepest_rise = 0.0;
  for (const StepValue& grade : scenario.track.Grades()) {
    steepest_fall = std::max(steepest_fall, -grade.value);
    steepest_rise = std::max(steepest_rise, grade.value);
  }
  double front_m = scenario.start_position_m + 0.5 * scenario.train.consist.front().vehicle.length_m;
  double rear_m = front_m;
  for (const ConsistGroupParams& group : scenario.train.consist)
    rear_m -= group.count * group.vehicle.length_m;
  const double time_s = scenario.duration_s;
  double fastest_mps = 0.0, slowest_mps = 0.0, traction_n = 0.0, weight_n = 0.0;
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    const ConsistGroupParams& group = scenario.train.consist[i];
    fastest_mps = std::max(fastest_mps, scenario.InitialSpeedOfGroup(i));
    slowest_mps = std::min(slowest_mps, scenario.InitialSpeedOfGroup(i));
    weight_n += group.count * group.vehicle.Weight();
    if (!group.vehicle.traction) continue;
    traction_n += group.count * group.vehicle.traction->tractive_effort.starting_effort_n;
  }
  const auto way = [&](double start_mps, double slope) {
    return time_s * (std::max(0.0, start_mps) + 0.5 * kGravity * slope * time_s);
  };
  return {rear_m - way(-slowest_mps, steepest_rise),
          front_m + way(fastest_mps, steepest_fall + traction_n / weight_n)};
}

/// Warns once of the entries of a list of the track that no wheel reaches.
template <class Entry, class EndOf>
void WarnOfReach(const std::string& list, const std::vector<Entry>& entries, const EndOf& end_of,
                 const Stretch& reach, std::vector<Warning>& warnings) {
  std::size_t beyond = 0, first = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].from_m < reach.to_m && end_of(entries[i]) > reach.from_m) continue;
    if (beyond++ == 0) first = i;
  }
  if (beyond == 0) return;
  const std::string key = list + Index(first);
  warnings.push_back({key, key + " on [" + Short(entries[first].from_m) + ", " +
                               Short(end_of(entries[first])) + "] m is reached by no wheel: they are on [" +
                               Short(reach.from_m) + ", " + Short(reach.to_m) + "] m at most in this run" +
                               (beyond == 1 ? "" : " (" + Counted(beyond) + " of " + list + " are not)")});
}

/// Where a train does not begin on its route.
void WarnOfStart(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  const Stretch route = scenario.track.Extent();
  if (scenario.train.consist.empty()) return;
  const double front_m = scenario.start_position_m + 0.5 * scenario.train.consist.front().vehicle.length_m;
  double rear_m = front_m;
  for (const ConsistGroupParams& group : scenario.train.consist)
    rear_m -= group.count * group.vehicle.length_m;
  if (rear_m >= route.from_m && front_m <= route.to_m) return;
  warnings.push_back({"start_position_m", "the train begins between " + Short(rear_m) + " m and " +
                                              Short(front_m) + " m, beyond an end of its route (" +
                                              Short(route.from_m) + " m to " + Short(route.to_m) +
                                              " m), where the first or the last of its values holds on"});
}

/// Warns of a locomotive whose effort is more than a rail gives or than its own power.
void WarnOfTraction(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  constexpr double kLargestAdhesion = 0.36;
  constexpr double kRounding = 1e-3;  // of efforts in tables
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    const VehicleParams& vehicle = scenario.train.consist[i].vehicle;
    if (!vehicle.traction) continue;
    const TractiveEffortParams& effort = vehicle.traction->tractive_effort;
    const std::string part = "train.consist" + Index(i) + ".vehicle.traction.tractive_effort.";
    const double adhesion = effort.starting_effort_n / vehicle.DrivenWeight();
    if (adhesion > kLargestAdhesion) {
      warnings.push_back({part + "starting_effort_n", part + "starting_effort_n asks for " + Short(adhesion) +
                                                          " of the weight on the driven wheels, more than " +
                                                          Short(kLargestAdhesion) +
                                                          ", which a dry rail gives to a modern locomotive"});
    }
    const double power_w = effort.table ? effort.table->LargestPower() : 0.0;
    if (power_w > (1.0 + kRounding) * effort.rim_power_w) {
      warnings.push_back({part + "table", part + "table asks for " + Short(power_w) +
                                              " W, more than rim_power_w " + Short(effort.rim_power_w) +
                                              ", which limits it there"});
    }
  }
}

}  // namespace

namespace {

/// ", which has ...", for a rule about names.
std::string KnownNames(const std::vector<std::string>& names) {
  if (names.empty()) return ", which has none";
  std::string text = ": ";
  for (const std::string& name : names) text += (text == ": " ? "" : ", ") + name;
  return text;
}

/// The names of the groups that have locomotives, each once.
std::vector<std::string> LocomotiveGroups(const TrainParams& train) {
  std::vector<std::string> names;
  for (const ConsistGroupParams& group : train.consist) {
    if (group.vehicle.traction && !group.name.empty() &&
        std::find(names.begin(), names.end(), group.name) == names.end())
      names.push_back(group.name);
  }
  return names;
}

/// A text that speaks of commands[k], where k counts those of the brake, with the numbers of the whole list.
std::string Renumbered(const std::string& text, const std::vector<std::size_t>& index) {
  const std::string list = "commands[";
  std::string renumbered;
  std::size_t at = 0;
  for (std::size_t found; (found = text.find(list, at)) != std::string::npos;) {
    const std::size_t number = found + list.size(), end = text.find(']', number);
    renumbered += text.substr(at, number - at) + std::to_string(index.at(std::stoul(text.substr(number))));
    at = end;
  }
  return renumbered + text.substr(at);
}

}  // namespace

int ScenarioParams::StepsPerExchange() const { return static_cast<int>(Parts(exchange_interval_s, dt_s)); }
long ScenarioParams::Exchanges() const { return Parts(duration_s, exchange_interval_s); }
int ScenarioParams::ExchangesPerRecord() const {
  return static_cast<int>(Parts(record_interval_s, exchange_interval_s));
}
int ScenarioParams::RecordsPerLedger() const {
  return static_cast<int>(Parts(ledger_interval_s, record_interval_s));
}

double ScenarioParams::MeanInitialSpeed() const {
  double mass = 0.0, momentum = 0.0;
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const double of_group = train.consist[i].count * train.consist[i].vehicle.TotalMass();
    mass += of_group;
    momentum += of_group * InitialSpeedOfGroup(i);
  }
  return momentum / mass;
}

bool ScenarioParams::Uses(VehicleModel wanted) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (ModelOfGroup(i) == wanted) return true;
  }
  return train.consist.empty() && model == wanted;
}

std::vector<VehicleModel> ScenarioParams::VehicleModels() const {
  std::vector<VehicleModel> models;
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    models.insert(models.end(), train.consist[i].count, ModelOfGroup(i));
  }
  return models;
}

std::string ScenarioParams::ModelNames() const {
  std::string names;
  for (const auto& [key, known] : kVehicleModels) {
    if (Uses(known)) names += (names.empty() ? "" : ", ") + std::string(key);
  }
  return names;
}

ScenarioParams ScenarioParams::WithBuiltInVehicles() const {
  ScenarioParams built_in = *this;
  for (ConsistGroupParams& group : built_in.train.consist) {
    if (group.external.empty()) continue;
    group.model = VehicleModel::kLtd;
    group.external.clear();
  }
  return built_in;
}

std::vector<int> ScenarioParams::DetailedVehicles() const {
  std::vector<int> detailed;
  if (!Uses(VehicleModel::kTwoD)) return detailed;
  const std::vector<VehicleModel> models = VehicleModels();
  for (int number : detail_vehicles) {
    const int vehicle = VehicleIndex(number, static_cast<int>(models.size()));
    if (models[vehicle] == VehicleModel::kTwoD) detailed.push_back(vehicle);
  }
  std::sort(detailed.begin(), detailed.end());
  detailed.erase(std::unique(detailed.begin(), detailed.end()), detailed.end());
  return detailed;
}

bool ScenarioParams::Multiple(double whole, double part) {
  const double ratio = whole / part;
  return ratio > 0.5 && ratio < 1e9 &&
         std::abs(ratio - std::round(ratio)) < 1e-6 * std::max(1.0, 1e-3 * ratio);
}

std::vector<BrokenRule> ScenarioParams::BrokenRules() const {
  std::vector<BrokenRule> broken;
  JudgeNodes(broken);
  JudgeTimes(broken);
  JudgeBrake(broken);
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (ModelOfGroup(i) != VehicleModel::kTwoD || !train.consist[i].vehicle.IsOneMass()) continue;
    broken.push_back(
        {"train.consist" + Index(i) + ".vehicle.mass_kg",
         "is all that the vehicle has, but the 2d model needs its bodies (carbody, bolster, bogie_frame, "
         "wheelset ...); run it with the ltd model, or say model: ltd for the group",
         {"train", "model"}});
  }
  const int vehicles = train.VehicleCount();
  for (std::size_t i = 0; i < detail_vehicles.size(); ++i) {
    const int vehicle = VehicleIndex(detail_vehicles[i], vehicles);
    if (vehicle < 0) {
      broken.push_back({"detail_vehicles" + Index(i), VehicleRule(vehicles), {"train"}});
    } else if (VehicleModels()[vehicle] == VehicleModel::kTwoD &&
               train.VehicleAt(vehicle).wheelsets_per_bogie != 2) {
      broken.push_back({"detail_vehicles" + Index(i),
                        "must be a vehicle with wheelsets_per_bogie 2: full detail is not recorded of others",
                        {"train"}});
    }
  }
  JudgeDriver(broken);
  JudgeDips(broken);
  JudgeSlideProtection(broken);
  const std::vector<DriverCommand> named = WithVehicles(commands, train);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].IsOfLocomotives()) continue;
    if (!named[i].group.empty()) {
      broken.push_back(
          {"commands" + Index(i) + ".group",
           "must be the name of a group of locomotives of the train" + KnownNames(LocomotiveGroups(train)),
           {"train"}});
      continue;
    }
    for (const BrokenRule& rule :
         JudgeLocomotiveCommand(named[i].OfLocomotives(0.0), "commands" + Index(i), train))
      broken.push_back(rule);
  }
  return broken;
}

void ScenarioParams::JudgeNodes(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const std::string& node = train.consist[i].external;
    for (std::size_t other = 0; !node.empty() && other < i; ++other) {
      if (train.consist[other].external != node) continue;
      broken.push_back({"train.consist" + Index(i) + ".external",
                        "must differ from that of consist" + Index(other) + ": a node moves one group",
                        {"train"}});
      break;
    }
  }
}

void ScenarioParams::JudgeTimes(std::vector<BrokenRule>& broken) const {
  double last_s = 0.0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].time_s) continue;
    if (*commands[i].time_s < last_s) {
      broken.push_back({"commands" + Index(i) + ".time_s",
                        "must be at least that of the command before, " + ShortestDecimal(last_s) + " s",
                        {"commands"}});
    }
    last_s = *commands[i].time_s;
  }
}

void ScenarioParams::JudgeBrake(std::vector<BrokenRule>& broken) const {
  if (!brake || !pressure_table.empty()) return;
  const auto judge = [&](const std::vector<BrakeCommand>& of_brake, const std::vector<std::size_t>& index) {
    for (const BrokenRule& rule : brake->BrokenRules(of_brake, train.VehicleCount())) {
      const bool is_known = std::any_of(broken.begin(), broken.end(), [&](const BrokenRule& other) {
        return other.key == Renumbered(rule.key, index);
      });
      if (!is_known)
        broken.push_back({Renumbered(rule.key, index), Renumbered(rule.text, index), rule.reads});
    }
  };
  std::vector<std::size_t> index;
  const std::vector<BrakeCommand> timed = TimedBrakeCommands(commands, &index);
  judge(timed, index);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].time_s && !commands[i].IsOfLocomotives()) judge({commands[i].OfBrake(0.0)}, {i});
  }
}

void ScenarioParams::JudgeDriver(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const ConsistGroupParams& group = train.consist[i];
    const std::string key = "train.consist" + Index(i) + ".initial_";
    for (const bool is_throttle : {true, false}) {
      const double notch = is_throttle ? group.initial_throttle_notch : group.initial_dynamic_brake_notch;
      if (notch == 0.0) continue;
      const auto& traction = group.vehicle.traction;
      const int notches = !traction                 ? 0
                          : is_throttle             ? traction->tractive_effort.throttle.Notches()
                          : traction->dynamic_brake ? traction->dynamic_brake->Notches()
                                                    : 0;
      if (notch <= notches) continue;
      broken.push_back({key + (is_throttle ? "throttle_notch" : "dynamic_brake_notch"),
                        "must be at most " + std::to_string(notches) + ", what the vehicle of the group has",
                        {"train"}});
    }
  }
  if (initial_reduction_kpa > 0.0) {
    if (!brake || !pressure_table.empty()) {
      broken.push_back(
          {"initial_reduction_kpa", "needs brake: a pressure_table has its own start", {"pressure_table"}});
    } else {
      for (const BrokenRule& rule : brake->BrokenRules(
               {{0.0, BrakeCommandKind::kApply, initial_reduction_kpa}}, train.VehicleCount())) {
        if (rule.key.rfind("commands", 0) == 0)
          broken.push_back({"initial_reduction_kpa", rule.text, rule.reads});
      }
    }
  }
  if (!driver) return;
  if (!Multiple(driver->period_s, exchange_interval_s)) {
    broken.push_back(
        {"driver.period_s", "must be a multiple of exchange_interval_s", {"exchange_interval_s"}});
  }
  if (!brake || !pressure_table.empty()) {
    broken.push_back(
        {"driver", "needs brake: a driver cannot drive with a pressure_table", {"pressure_table"}});
  } else {
    for (const bool is_first : {true, false}) {
      const double reduction_kpa = is_first ? driver->first_reduction_kpa : driver->largest_reduction_kpa;
      for (const BrokenRule& rule :
           brake->BrokenRules({{0.0, BrakeCommandKind::kApply, reduction_kpa}}, train.VehicleCount())) {
        if (rule.key.rfind("commands", 0) != 0) continue;
        broken.push_back({std::string("driver.") + (is_first ? "first" : "largest") + "_reduction_kpa",
                          rule.text,
                          {"brake"}});
      }
    }
  }
  double last_m = start_position_m;
  std::vector<std::string> stations;
  for (const StationParams& station : track.Stations()) stations.push_back(station.name);
  const std::vector<double> stops_m = StopPositions(*driver, track);
  for (std::size_t i = 0; i < driver->stops.size(); ++i) {
    const StopParams& stop = driver->stops[i];
    const std::string key = "driver.stops" + Index(i);
    if (!stop.position_m && std::find(stations.begin(), stations.end(), stop.station) == stations.end()) {
      broken.push_back(
          {key + ".station", "must be a station of the track" + KnownNames(stations), {"track"}});
      continue;
    }
    if (stops_m[i] <= last_m) {
      broken.push_back({key,
                        "must lie ahead of the start and of the stop before, beyond " + Short(last_m) + " m",
                        {"start_position_m", "track"}});
    }
    last_m = stops_m[i];
  }
}

void ScenarioParams::JudgeDips(std::vector<BrokenRule>& broken) const {
  if (!Uses(VehicleModel::kTwoD) || train.consist.empty()) return;
  /// Where vehicles of the 2D model stand at the start, without a gap.
  struct StandingStretch {
    double rear_m, front_m;
  };
  std::vector<StandingStretch> stretches;
  double rear_m = start_position_m + 0.5 * train.consist.front().vehicle.length_m;
  bool goes_on = false;
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const bool is_two_d = ModelOfGroup(i) == VehicleModel::kTwoD;
    if (is_two_d && !goes_on) stretches.push_back({rear_m, rear_m});
    rear_m -= train.consist[i].count * train.consist[i].vehicle.length_m;
    if (is_two_d) stretches.back().rear_m = rear_m;
    goes_on = is_two_d;
  }
  const bool is_mixed = Uses(VehicleModel::kLtd) || Uses(VehicleModel::kLtdNoInertia);
  const std::string who = is_mixed ? "vehicles of the 2d model at their start, which stand"
                                   : "the train at its start, which stands";
  for (std::size_t i = 0; i < track.dips.size(); ++i) {
    const DipParams& dip = track.dips[i];
    if (dip.depth_m == 0.0) continue;
    for (const StandingStretch& stretch : stretches) {
      if (!(dip.from_m < stretch.front_m && dip.from_m + dip.length_m > stretch.rear_m)) continue;
      broken.push_back({"track.dips" + Index(i),
                        "must not lie under " + who + " on [" + Short(stretch.rear_m) + ", " +
                            Short(stretch.front_m) + "] m; the dip is on [" + Short(dip.from_m) + ", " +
                            Short(dip.from_m + dip.length_m) + "] m",
                        {"train", "start_position_m", "model"}});
      break;
    }
  }
}

void ScenarioParams::JudgeSlideProtection(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (ModelOfGroup(i) != VehicleModel::kTwoD) continue;
    const std::optional<TractionParams>& traction = train.consist[i].vehicle.traction;
    if (traction && traction->slip_control && !Multiple(traction->slip_control->sampling_period_s, dt_s)) {
      broken.push_back({"train.consist" + Index(i) + ".vehicle.traction.slip_control.sampling_period_s",
                        "must be a multiple of dt_s",
                        {"train", "dt_s", "model"}});
    }
    const std::optional<SlideProtectionParams>& protection = train.consist[i].vehicle.wheel_slide_protection;
    if (!protection) continue;
    const std::string part = "train.consist" + Index(i) + ".vehicle.wheel_slide_protection.";
    const auto must_be_multiple = [&](const std::string& key, double value) {
      if (value == 0.0 || Multiple(value, dt_s)) return;
      broken.push_back({part + key, "must be a multiple of dt_s", {"train", "dt_s", "model"}});
    };
    must_be_multiple("sampling_period_s", protection->sampling_period_s);
    must_be_multiple("valve.delay_s", protection->valve.delay_s);
  }
}

namespace {

/// Warns of groups of LTD vehicles whose brake asks for more than the rail gives somewhere.
void WarnOfAdhesionLimit(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  if (!scenario.brake || scenario.brake->kind != BrakeSystemKind::kEmpirical ||
      !scenario.pressure_table.empty())
    return;
  const double pressure_pa = 1e3 * scenario.brake->empirical.emergency.cylinder_pressure_kpa;
  const Stretch reach = ReachOf(scenario);
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    if (scenario.ModelOfGroup(i) == VehicleModel::kTwoD) continue;
    const VehicleParams& vehicle = scenario.train.consist[i].vehicle;
    if (vehicle.IsOneMass()) continue;  // it has no wheels
    double least = vehicle.wheel_rail.adhesion.friction_coefficient;
    for (const FrictionPatchParams& patch : scenario.track.Patches()) {
      if (patch.from_m >= reach.to_m || patch.to_m <= reach.from_m) continue;
      least = std::min(least,
                       patch.adhesion ? patch.adhesion->friction_coefficient : *patch.friction_coefficient);
    }
    const double asked = ShoeForce(vehicle.Rigging(), pressure_pa, 0.0) / vehicle.Weight();
    if (asked <= least) continue;
    const std::string key = "train.consist" + Index(i) + ".vehicle";
    warnings.push_back({key, "the brake of " + key + " asks in an emergency for up to " + Short(asked) +
                                 " of its weight where the rail gives " + Short(least) +
                                 (scenario.adhesion_limit
                                      ? ": adhesion_limit holds the wheel-rail force of its ltd model to that"
                                      : ", and its ltd model applies all of it: adhesion_limit is false")});
  }
}

}  // namespace

std::vector<Warning> Warnings(const ScenarioParams& scenario) {
  std::vector<Warning> warnings;
  const TrainParams& train = scenario.train;
  double lightest_kg = std::numeric_limits<double>::infinity();
  long units = 0;
  for (const ConsistGroupParams& group : train.consist) {
    lightest_kg = std::min(lightest_kg, group.vehicle.TotalMass());
    units += group.count / group.vehicles_per_unit;
  }
  if (units > 1) WarnOfConnection(scenario, "train.connection", train.connection, lightest_kg, warnings);
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const ConsistGroupParams& group = train.consist[i];
    if (group.vehicles_per_unit == 1) continue;
    WarnOfConnection(scenario, "train.consist" + Index(i) + ".unit_connection", group.unit_connection,
                     lightest_kg, warnings);
  }
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const WheelsetParams& wheelset = train.consist[i].vehicle.wheelset;
    if (train.consist[i].vehicle.IsOneMass() || wheelset.accept_large_inertia ||
        !(wheelset.InertiaRatio() > 1.0))
      continue;
    const std::string group = "train.consist" + Index(i) + ".vehicle.wheelset.";
    warnings.push_back(
        {group + "pitch_inertia_kgm2",
         group + "pitch_inertia_kgm2 is " + Short(wheelset.InertiaRatio()) +
             " times mass_kg wheel_radius_m^2, more than if all mass were at the tread (a real "
             "freight wheelset has 100 to 130 kg m2): its wheels lock later, slide less far and "
             "turn again sooner than real ones; if that is meant, say accept_large_inertia: true"});
  }
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const VehicleModel model = scenario.ModelOfGroup(i);
    if (model == VehicleModel::kTwoD || !train.consist[i].vehicle.wheel_slide_protection) continue;
    const std::string key = "train.consist" + Index(i) + ".vehicle.wheel_slide_protection";
    warnings.push_back({key, std::string("the ") + ModelName(model) + " model leaves out " + key +
                                 ": its wheels neither slide nor lock"});
  }
  WarnOfTraction(scenario, warnings);
  for (const VehicleModel model : {VehicleModel::kLtd, VehicleModel::kLtdNoInertia}) {
    if (!scenario.Uses(model)) continue;
    const auto leaves_out = [&](const std::string& key, std::size_t entries) {
      if (entries == 0) return;
      warnings.push_back({key, std::string("the ") + ModelName(model) + " model leaves out " + key + " (" +
                                   Counted(entries) + ")"});
    };
    leaves_out("track.dips", scenario.track.dips.size());
    if (!scenario.adhesion_limit)
      leaves_out("track.friction_patches", scenario.track.friction_patches.size());
  }
  WarnOfStart(scenario, warnings);
  if (scenario.Uses(VehicleModel::kTwoD) && !train.consist.empty()) {
    const Stretch reach = ReachOf(scenario);
    WarnOfReach(
        "track.dips", scenario.track.dips, [](const DipParams& dip) { return dip.from_m + dip.length_m; },
        reach, warnings);
    WarnOfReach(
        "track.friction_patches", scenario.track.friction_patches,
        [](const FrictionPatchParams& patch) { return patch.to_m + 0.5 * patch.RampLength(); }, reach,
        warnings);
  }
  if (scenario.Uses(VehicleModel::kTwoD)) {
    const std::vector<VehicleModel> models = scenario.VehicleModels();
    for (std::size_t i = 0; i < scenario.detail_vehicles.size(); ++i) {
      const int number = scenario.detail_vehicles[i];
      const VehicleModel model = models[VehicleIndex(number, static_cast<int>(models.size()))];
      if (model == VehicleModel::kTwoD) continue;
      const std::string key = "detail_vehicles" + Index(i);
      warnings.push_back({key, key + " is " + std::to_string(number) + ", a vehicle of the " +
                                   ModelName(model) + " model, which has no details"});
    }
  }
  if (!train.consist.empty()) WarnOfAdhesionLimit(scenario, warnings);
  if (scenario.brake && scenario.pressure_table.empty()) {
    std::vector<std::size_t> index;
    const std::vector<BrakeCommand> timed = TimedBrakeCommands(scenario.commands, &index);
    for (const Warning& warning : scenario.brake->Warnings(timed, train.VehicleCount()))
      warnings.push_back({Renumbered(warning.key, index), Renumbered(warning.text, index)});
  }
  if (!scenario.pressure_table.empty()) {
    const std::string unused = " not used: the pressures come from pressure_table";
    if (scenario.brake) warnings.push_back({"brake", "brake is" + unused});
    if (train.connection.strength_n > 0.0) {
      warnings.push_back({"train.connection.strength_n",
                          "the brake pipe stays closed where a connection breaks: the pressures come from "
                          "pressure_table"});
    }
    const auto of_brake =
        std::count_if(scenario.commands.begin(), scenario.commands.end(),
                      [](const DriverCommand& command) { return !command.IsOfLocomotives(); });
    if (of_brake > 0) {
      warnings.push_back({"commands", "commands of the brake (" +
                                          Counted(static_cast<std::size_t>(of_brake)) + ") are" + unused});
    }
  }
  return warnings;
}

BrakeSystem MakeBrakeSystem(const ScenarioParams& scenario, const Consist& consist) {
  std::vector<double> length_m;
  for (int i = 0; i < consist.vehicles(); ++i) length_m.push_back(consist.vehicle(i).length_m);
  const PressureGrid grid{scenario.exchange_interval_s, scenario.ExchangesPerRecord()};
  const std::vector<BrakeCommand> timed = TimedBrakeCommands(scenario.commands);
  if (scenario.initial_reduction_kpa == 0.0)
    return {*scenario.brake, timed, consist.centre_m, grid, length_m};
  constexpr double kSettle_s = 120.0;
  BrakeSystem applied(*scenario.brake, {{0.0, BrakeCommandKind::kApply, scenario.initial_reduction_kpa}},
                      consist.centre_m, grid, length_m);
  std::vector<double> pressure_pa;
  applied.PressuresAt(kSettle_s, pressure_pa);
  applied.MoveAhead(kSettle_s);
  for (const BrakeCommand& command : timed) applied.Command(command);
  return applied;
}

}  // namespace train_dynamics
