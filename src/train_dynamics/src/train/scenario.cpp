#include "train_dynamics/train/scenario.h"

#include <algorithm>
#include <cmath>

#include "train_dynamics/train/built_in_driver.h"

namespace train_dynamics {
namespace {

/// How many parts make up a whole that is known to be a multiple.
long Parts(double whole, double part) { return std::lround(whole / part); }

/// ", which has ...", for a rule about names.
std::string KnownNames(const std::vector<std::string>& names) {
  if (names.empty()) return ", which has none";
  std::string text = ": ";
  for (const std::string& name : names) text += (text == ": " ? "" : ", ") + name;
  return text;
}

std::string OfGroup(std::size_t group) { return "train.consist" + ListIndex(group); }

// What rules read of all groups.
const char kModels[] = "train.consist[].model";
const char kNames[] = "train.consist[].name";
const char kTraction[] = "train.consist[].vehicle.traction";
const std::vector<std::string> kWhichBrake = {"pressure_table", "brake.kind"};
const std::vector<std::string> kStations = {"track.stations", "track.points[].station", "track.points[].position_m",
                                            "track.points[].position_km"};

}  // namespace

std::string RuleOfGroup(const DriverCommand& command, const TrainParams& train) {
  std::vector<std::string> names;
  for (const ConsistGroupParams& group : train.consist) {
    if (ActsOn(command, group) && !group.name.empty() &&
        std::find(names.begin(), names.end(), group.name) == names.end())
      names.push_back(group.name);
  }
  return "must be the name of a group of locomotives of the train" + KnownNames(names);
}

int ScenarioParams::StepsPerExchange() const { return static_cast<int>(Parts(exchange_interval_s, dt_s)); }
long ScenarioParams::Exchanges() const { return Parts(duration_s, exchange_interval_s); }
int ScenarioParams::ExchangesPerRecord() const {
  return static_cast<int>(Parts(record_interval_s, exchange_interval_s));
}
int ScenarioParams::RecordsPerLedger() const { return static_cast<int>(Parts(ledger_interval_s, record_interval_s)); }

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
  return ratio > 0.5 && ratio < 1e9 && std::abs(ratio - std::round(ratio)) < 1e-6 * std::max(1.0, 1e-3 * ratio);
}

std::vector<BrokenRule> ScenarioParams::BrokenRules() const {
  std::vector<BrokenRule> broken;
  JudgeNodes(broken);
  JudgeTimes(broken);
  JudgeBrake(broken);
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (ModelOfGroup(i) != VehicleModel::kTwoD || !train.consist[i].vehicle.IsOneMass()) continue;
    broken.push_back({OfGroup(i) + ".vehicle.mass_kg",
                      "is all that the vehicle has, but the 2d model needs its bodies (carbody, bolster, bogie_frame, "
                      "wheelset ...); run it with the ltd model, or say model: ltd for the group",
                      {"model", OfGroup(i) + ".model"}});
  }
  const int vehicles = train.VehicleCount();
  for (std::size_t i = 0; i < detail_vehicles.size(); ++i) {
    const int vehicle = VehicleIndex(detail_vehicles[i], vehicles);
    if (vehicle < 0) {
      broken.push_back({"detail_vehicles" + ListIndex(i), VehicleRule(vehicles), {kVehicleCounts}});
    } else if (VehicleModels()[vehicle] == VehicleModel::kTwoD && train.VehicleAt(vehicle).wheelsets_per_bogie != 2) {
      broken.push_back({"detail_vehicles" + ListIndex(i),
                        "must be a vehicle with wheelsets_per_bogie 2: full detail is not recorded of others",
                        {kVehicleCounts, "model", kModels, "train.consist[].vehicle.wheelsets_per_bogie"}});
    }
  }
  JudgeDriver(broken);
  JudgeDips(broken);
  JudgeSlideProtection(broken);
  const std::vector<DriverCommand> named = WithVehicles(commands, train);
  std::size_t patches = 0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].IsOfTrainBrake()) continue;
    if (commands[i].IsOfRail()) {
      for (const BrokenRule& rule : JudgePatch(commands[i].OfRail(), "commands" + ListIndex(i), track))
        broken.push_back(rule);
      if (++patches == kMostPatchesOnTheWay + 1)
        broken.push_back({"commands" + ListIndex(i) + ".kind", RuleOfPatches(), {}});
      continue;
    }
    if (!named[i].group.empty()) {
      broken.push_back({"commands" + ListIndex(i) + ".group", RuleOfGroup(named[i], train), {kNames, kTraction}});
      continue;
    }
    if (commands[i].IsOfLocomotiveBrakes() && brake) {
      for (const BrokenRule& rule :
           JudgeLocomotiveBrakeCommand(named[i].OfLocomotiveBrakes(0.0), "commands" + ListIndex(i), train, *brake))
        broken.push_back(rule);
    }
    if (!commands[i].IsOfLocomotives()) continue;
    for (const BrokenRule& rule : JudgeLocomotiveCommand(named[i].OfLocomotives(0.0), "commands" + ListIndex(i), train))
      broken.push_back(rule);
  }
  return broken;
}

void ScenarioParams::JudgeNodes(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const std::string& node = train.consist[i].external;
    for (std::size_t other = 0; !node.empty() && other < i; ++other) {
      if (train.consist[other].external != node) continue;
      broken.push_back({OfGroup(i) + ".external",
                        "must differ from that of consist" + ListIndex(other) + ": a node moves one group",
                        {OfGroup(other) + ".external"}});
      break;
    }
  }
}

void ScenarioParams::JudgeTimes(std::vector<BrokenRule>& broken) const {
  double last_s = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].time_s) continue;
    if (*commands[i].time_s < last_s) {
      broken.push_back({"commands" + ListIndex(i) + ".time_s",
                        "must be at least that of the command before, " + ShortestDecimal(last_s) + " s",
                        {"commands" + ListIndex(last) + ".time_s"}});
    }
    last_s = *commands[i].time_s;
    last = i;
  }
}

void ScenarioParams::JudgeBrake(std::vector<BrokenRule>& broken) const {
  if (!brake || !pressure_table.empty()) return;
  const auto judge = [&](const std::vector<BrakeCommand>& of_brake, const std::vector<std::size_t>& index) {
    for (const BrokenRule& rule : brake->BrokenRules(of_brake, train.VehicleCount())) {
      const bool is_known = std::any_of(broken.begin(), broken.end(), [&](const BrokenRule& other) {
        return other.key == RenumberedCommands(rule.key, index);
      });
      if (!is_known)
        broken.push_back({RenumberedCommands(rule.key, index), RenumberedCommands(rule.text, index), rule.reads});
    }
  };
  std::vector<std::size_t> index;
  const std::vector<BrakeCommand> timed = TimedBrakeCommands(commands, &index);
  judge(timed, index);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].time_s && commands[i].IsOfTrainBrake()) judge({commands[i].OfBrake(0.0)}, {i});
  }
}

void ScenarioParams::JudgeDriver(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const ConsistGroupParams& group = train.consist[i];
    const std::string key = OfGroup(i) + ".initial_";
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
                        {OfGroup(i) + ".vehicle"}});
    }
  }
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (!train.consist[i].trapped_cylinder_pressure_kpa || (brake && pressure_table.empty())) continue;
    broken.push_back({OfGroup(i) + ".trapped_cylinder_pressure_kpa",
                      "needs brake: a pressure_table has the pressures of all vehicles", kWhichBrake});
  }
  if (initial_reduction_kpa > 0.0) {
    if (!brake || !pressure_table.empty()) {
      broken.push_back({"initial_reduction_kpa", "needs brake: a pressure_table has its own start", kWhichBrake});
    } else {
      for (const BrokenRule& rule :
           brake->BrokenRules({{0.0, BrakeCommandKind::kApply, initial_reduction_kpa}}, train.VehicleCount())) {
        if (rule.key.rfind("commands", 0) == 0) broken.push_back({"initial_reduction_kpa", rule.text, rule.reads});
      }
    }
  }
  if (!driver) return;
  if (!Multiple(driver->period_s, exchange_interval_s)) {
    broken.push_back({"driver.period_s", "must be a multiple of exchange_interval_s", {"exchange_interval_s"}});
  }
  if (!brake || !pressure_table.empty()) {
    broken.push_back({"driver", "needs brake: a driver cannot drive with a pressure_table", kWhichBrake});
  } else {
    for (const bool is_first : {true, false}) {
      const double reduction_kpa = is_first ? driver->first_reduction_kpa : driver->largest_reduction_kpa;
      for (const BrokenRule& rule :
           brake->BrokenRules({{0.0, BrakeCommandKind::kApply, reduction_kpa}}, train.VehicleCount())) {
        if (rule.key.rfind("commands", 0) != 0) continue;
        broken.push_back(
            {std::string("driver.") + (is_first ? "first" : "largest") + "_reduction_kpa", rule.text, rule.reads});
      }
    }
  }
  double last_m = start_position_m;
  std::vector<std::string> stations;
  for (const StationParams& station : track.Stations()) stations.push_back(station.name);
  const std::vector<double> stops_m = StopPositions(*driver, track);
  for (std::size_t i = 0; i < driver->stops.size(); ++i) {
    const StopParams& stop = driver->stops[i];
    const std::string key = "driver.stops" + ListIndex(i);
    if (!stop.position_m && std::find(stations.begin(), stations.end(), stop.station) == stations.end()) {
      broken.push_back({key + ".station", "must be a station of the track" + KnownNames(stations), kStations});
      continue;
    }
    if (stops_m[i] <= last_m) {
      std::vector<std::string> reads = kStations;
      reads.insert(reads.end(), {"start_position_m", key, "driver.stops" + ListIndex(i == 0 ? i : i - 1)});
      broken.push_back(
          {key, "must lie ahead of the start and of the stop before, beyond " + ShortNumber(last_m) + " m", reads});
    }
    last_m = stops_m[i];
  }
}

void ScenarioParams::JudgeDips(std::vector<BrokenRule>& broken) const {
  if (!Uses(VehicleModel::kTwoD) || train.consist.empty()) return;
  /// The positions of the 2D vehicles at the start, without a gap.
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
  const std::string who =
      is_mixed ? "vehicles of the 2d model at their start, which stand" : "the train at its start, which stands";
  for (std::size_t i = 0; i < track.dips.size(); ++i) {
    const DipParams& dip = track.dips[i];
    if (dip.depth_m == 0.0) continue;
    for (const StandingStretch& stretch : stretches) {
      if (!(dip.from_m < stretch.front_m && dip.from_m + dip.length_m > stretch.rear_m)) continue;
      broken.push_back({"track.dips" + ListIndex(i),
                        "must not lie under " + who + " on [" + ShortNumber(stretch.rear_m) + ", " +
                            ShortNumber(stretch.front_m) + "] m; the dip is on [" + ShortNumber(dip.from_m) + ", " +
                            ShortNumber(dip.from_m + dip.length_m) + "] m",
                        {"track.dips" + ListIndex(i), "start_position_m", "model", kModels, kVehicleCounts,
                         "train.consist[].vehicle.length_m"}});
      break;
    }
  }
}

void ScenarioParams::JudgeSlideProtection(std::vector<BrokenRule>& broken) const {
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    if (ModelOfGroup(i) != VehicleModel::kTwoD) continue;
    const VehicleParams& vehicle = train.consist[i].vehicle;
    const auto must_be_multiple = [&](const std::string& key, double value) {
      if (value == 0.0 || Multiple(value, dt_s)) return;
      broken.push_back(
          {OfGroup(i) + ".vehicle." + key, "must be a multiple of dt_s", {"dt_s", "model", OfGroup(i) + ".model"}});
    };
    if (vehicle.traction && vehicle.traction->slip_control)
      must_be_multiple("traction.slip_control.sampling_period_s", vehicle.traction->slip_control->sampling_period_s);
    if (!vehicle.wheel_slide_protection) continue;
    const SlideProtectionParams& protection = *vehicle.wheel_slide_protection;
    must_be_multiple("wheel_slide_protection.sampling_period_s", protection.sampling_period_s);
    must_be_multiple("wheel_slide_protection.valve.delay_s", protection.valve.delay_s);
  }
}

BrakeSystem MakeBrakeSystem(const ScenarioParams& scenario, const Consist& consist) {
  std::vector<double> length_m;
  length_m.reserve(consist.vehicles());
  for (int i = 0; i < consist.vehicles(); ++i) length_m.push_back(consist.vehicle(i).length_m);
  const PressureGrid grid{scenario.exchange_interval_s, scenario.ExchangesPerRecord()};
  const auto brake_with = [&](const std::vector<BrakeCommand>& commands) {
    BrakeSystem made(*scenario.brake, commands, consist.centre_m, grid, length_m);
    for (int i = 0; i < consist.vehicles(); ++i) {
      const auto& trapped_kpa = scenario.train.consist[consist.vehicle_type[i]].trapped_cylinder_pressure_kpa;
      if (trapped_kpa) made.TrapAir(i, *trapped_kpa * 1e3);
    }
    return made;
  };
  const std::vector<BrakeCommand> timed = TimedBrakeCommands(scenario.commands);
  const bool is_applied = scenario.initial_reduction_kpa > 0.0;
  BrakeSystem brake =
      is_applied ? brake_with({{0.0, BrakeCommandKind::kApply, scenario.initial_reduction_kpa}}) : brake_with(timed);
  if (is_applied) {
    constexpr double kSettleSeconds = 120.0;
    std::vector<double> pressure_pa;
    brake.PressuresAt(kSettleSeconds, pressure_pa);
    brake.MoveAhead(kSettleSeconds);
    for (const BrakeCommand& command : timed) brake.Command(command);
  }
  std::vector<LocomotiveBrakes::Locomotive> locomotives;
  for (int i : consist.locomotives) locomotives.push_back({i, consist.command_delay_s[consist.vehicle_type[i]]});
  brake.SetLocomotiveBrakes(LocomotiveBrakes(scenario.brake->locomotive_brake, locomotives, consist.vehicles()));
  for (const LocomotiveBrakeCommand& command :
       TimedLocomotiveBrakeCommands(WithVehicles(scenario.commands, scenario.train)))
    brake.Command(command);
  return brake;
}

}  // namespace train_dynamics
