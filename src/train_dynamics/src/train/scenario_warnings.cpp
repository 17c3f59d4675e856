#include "train_dynamics/train/scenario_warnings.h"

#include <algorithm>
#include <limits>

#include "train_dynamics/train/exchange_stability.h"

namespace train_dynamics {
namespace {

std::string Counted(std::size_t entries) { return std::to_string(entries) + (entries == 1 ? " entry" : " entries"); }

/// Warns of a connection for which the exchange interval or the step is too long.
void WarnOfConnection(const ScenarioParams& scenario, const std::string& key, const ConnectionParams& connection,
                      double lightest_kg, std::vector<Warning>& warnings) {
  const ConnectionLaw law = connection.Law();
  const bool depends_on_force =
      std::visit([](const auto& of) { return of.TangentAt(kLargeCouplerForce).depends_on_force; }, law);
  const double longest_s = LongestStableExchange(connection, LightestCouplerHead(scenario));
  // A multiple of dt_s may exceed the limit by no more than a rounding error.
  if (scenario.exchange_interval_s > (1.0 + 1e-9) * longest_s) {
    warnings.push_back({"exchange_interval_s", "exchange_interval_s " + ShortNumber(scenario.exchange_interval_s) +
                                                   " is above " + ShortNumber(longest_s) +
                                                   ", the longest stable one of " + key +
                                                   (depends_on_force ? " at 900 kN" : "") +
                                                   ": coupler forces may diverge; take a shorter one"});
  }
  const auto* smooth = std::get_if<SmoothGears>(&law);
  if (smooth == nullptr) return;
  const std::string speed_key = key + ".draft_gear.smoothing_speed_mps";
  const double speed_mps = smooth->params.smoothing_speed_mps;
  const double lowest_mps = smooth->LeastSmoothingSpeed(kLargeCouplerForce, scenario.dt_s, lightest_kg);
  if (speed_mps >= lowest_mps) return;
  warnings.push_back({speed_key, speed_key + " " + ShortNumber(speed_mps) + " is below " + ShortNumber(lowest_mps) +
                                     ", the least for dt_s " + ShortNumber(scenario.dt_s) + " at 900 kN and " +
                                     ShortNumber(lightest_kg) +
                                     " kg: the friction of the draft gears may chatter; take a smaller dt_s"});
}

/// The range of positions that wheels can reach in a run.
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
  for (const ConsistGroupParams& group : scenario.train.consist) rear_m -= group.count * group.vehicle.length_m;
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
  return {rear_m - way(-slowest_mps, steepest_rise), front_m + way(fastest_mps, steepest_fall + traction_n / weight_n)};
}

/// Warns once of entries in a list of the track that no wheel reaches.
template <class Entry, class EndOf>
void WarnOfReach(const std::string& list, const std::vector<Entry>& entries, const EndOf& end_of, const Stretch& reach,
                 std::vector<Warning>& warnings) {
  std::size_t beyond = 0, first = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].from_m < reach.to_m && end_of(entries[i]) > reach.from_m) continue;
    if (beyond++ == 0) first = i;
  }
  if (beyond == 0) return;
  const std::string key = list + ListIndex(first);
  warnings.push_back({key, key + " on [" + ShortNumber(entries[first].from_m) + ", " +
                               ShortNumber(end_of(entries[first])) + "] m is reached by no wheel: they are on [" +
                               ShortNumber(reach.from_m) + ", " + ShortNumber(reach.to_m) + "] m at most in this run" +
                               (beyond == 1 ? "" : " (" + Counted(beyond) + " of " + list + " are not)")});
}

/// Warns of a train that does not begin on its route.
void WarnOfStart(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  const Stretch route = scenario.track.Extent();
  if (scenario.train.consist.empty()) return;
  const double front_m = scenario.start_position_m + 0.5 * scenario.train.consist.front().vehicle.length_m;
  double rear_m = front_m;
  for (const ConsistGroupParams& group : scenario.train.consist) rear_m -= group.count * group.vehicle.length_m;
  if (rear_m >= route.from_m && front_m <= route.to_m) return;
  warnings.push_back({"start_position_m", "the train begins between " + ShortNumber(rear_m) + " m and " +
                                              ShortNumber(front_m) + " m, beyond an end of its route (" +
                                              ShortNumber(route.from_m) + " m to " + ShortNumber(route.to_m) +
                                              " m), where the first or the last of its values holds on"});
}

/// Warns of a locomotive whose effort exceeds the adhesion or its own power.
void WarnOfTraction(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  constexpr double kLargestAdhesion = 0.36;
  constexpr double kRounding = 1e-3;  // of efforts in tables
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    const VehicleParams& vehicle = scenario.train.consist[i].vehicle;
    if (!vehicle.traction) continue;
    const TractiveEffortParams& effort = vehicle.traction->tractive_effort;
    const std::string part = "train.consist" + ListIndex(i) + ".vehicle.traction.tractive_effort.";
    const double adhesion = effort.starting_effort_n / vehicle.DrivenWeight();
    if (adhesion > kLargestAdhesion) {
      warnings.push_back({part + "starting_effort_n", part + "starting_effort_n asks for " + ShortNumber(adhesion) +
                                                          " of the weight on the driven wheels, more than " +
                                                          ShortNumber(kLargestAdhesion) +
                                                          ", which a dry rail gives to a modern locomotive"});
    }
    const double power_w = effort.table ? effort.table->LargestPower() : 0.0;
    if (power_w > (1.0 + kRounding) * effort.rim_power_w) {
      warnings.push_back({part + "table", part + "table asks for " + ShortNumber(power_w) +
                                              " W, more than rim_power_w " + ShortNumber(effort.rim_power_w) +
                                              ", which limits it there"});
    }
  }
}

/// Warns of groups of LTD vehicles whose brake force exceeds the adhesion somewhere.
void WarnOfAdhesionLimit(const ScenarioParams& scenario, std::vector<Warning>& warnings) {
  if (!scenario.brake || scenario.brake->kind != BrakeSystemKind::kEmpirical || !scenario.pressure_table.empty())
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
      least = std::min(least, patch.adhesion ? patch.adhesion->friction_coefficient : *patch.friction_coefficient);
    }
    const double asked = ShoeForce(vehicle.Rigging(), pressure_pa, 0.0) / vehicle.Weight();
    if (asked <= least) continue;
    const std::string key = "train.consist" + ListIndex(i) + ".vehicle";
    warnings.push_back(
        {key, "the brake of " + key + " asks in an emergency for up to " + ShortNumber(asked) +
                  " of its weight where the rail gives " + ShortNumber(least) +
                  (scenario.adhesion_limit ? ": adhesion_limit holds the wheel-rail force of its ltd model to that"
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
    WarnOfConnection(scenario, "train.consist" + ListIndex(i) + ".unit_connection", group.unit_connection, lightest_kg,
                     warnings);
  }
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const WheelsetParams& wheelset = train.consist[i].vehicle.wheelset;
    if (train.consist[i].vehicle.IsOneMass() || wheelset.accept_large_inertia || !(wheelset.InertiaRatio() > 1.0))
      continue;
    const std::string group = "train.consist" + ListIndex(i) + ".vehicle.wheelset.";
    warnings.push_back({group + "pitch_inertia_kgm2",
                        group + "pitch_inertia_kgm2 is " + ShortNumber(wheelset.InertiaRatio()) +
                            " times mass_kg wheel_radius_m^2, more than if all mass were at the tread (a real "
                            "freight wheelset has 100 to 130 kg m2): its wheels lock later, slide less far and "
                            "turn again sooner than real ones; if that is meant, say accept_large_inertia: true"});
  }
  for (std::size_t i = 0; i < train.consist.size(); ++i) {
    const VehicleModel model = scenario.ModelOfGroup(i);
    if (model == VehicleModel::kTwoD || !train.consist[i].vehicle.wheel_slide_protection) continue;
    const std::string key = "train.consist" + ListIndex(i) + ".vehicle.wheel_slide_protection";
    warnings.push_back({key, std::string("the ") + ModelName(model) + " model leaves out " + key +
                                 ": its wheels neither slide nor lock"});
  }
  WarnOfTraction(scenario, warnings);
  for (std::size_t i = 0; i < scenario.commands.size(); ++i) {
    const std::optional<double>& time_s = scenario.commands[i].time_s;
    if (!time_s || *time_s < scenario.duration_s) continue;
    const std::string key = "commands" + ListIndex(i) + ".time_s";
    warnings.push_back({key, key + " is " + ShortNumber(*time_s) + ", but the run ends at " +
                                 ShortNumber(scenario.duration_s) + " s: the command is never given"});
  }
  for (const VehicleModel model : {VehicleModel::kLtd, VehicleModel::kLtdNoInertia}) {
    if (!scenario.Uses(model)) continue;
    const auto leaves_out = [&](const std::string& key, std::size_t entries) {
      if (entries == 0) return;
      warnings.push_back(
          {key, std::string("the ") + ModelName(model) + " model leaves out " + key + " (" + Counted(entries) + ")"});
    };
    leaves_out("track.dips", scenario.track.dips.size());
    if (!scenario.adhesion_limit) leaves_out("track.friction_patches", scenario.track.friction_patches.size());
    const auto of_rail = std::count_if(scenario.commands.begin(), scenario.commands.end(),
                                       [](const DriverCommand& command) { return command.IsOfRail(); });
    if (!scenario.adhesion_limit && of_rail > 0)
      warnings.push_back({"commands", std::string("the ") + ModelName(model) +
                                          " model leaves out commands of kind friction (" +
                                          Counted(static_cast<std::size_t>(of_rail)) + ")"});
  }
  WarnOfStart(scenario, warnings);
  if ((scenario.Uses(VehicleModel::kTwoD) || scenario.adhesion_limit) && !train.consist.empty()) {
    const Stretch reach = ReachOf(scenario);
    if (scenario.Uses(VehicleModel::kTwoD))
      WarnOfReach(
          "track.dips", scenario.track.dips, [](const DipParams& dip) { return dip.from_m + dip.length_m; }, reach,
          warnings);
    WarnOfReach(
        "track.friction_patches", scenario.track.friction_patches,
        [](const FrictionPatchParams& patch) { return patch.to_m + 0.5 * patch.RampLength(); }, reach, warnings);
  }
  if (scenario.Uses(VehicleModel::kTwoD)) {
    const std::vector<VehicleModel> models = scenario.VehicleModels();
    for (std::size_t i = 0; i < scenario.detail_vehicles.size(); ++i) {
      const int number = scenario.detail_vehicles[i];
      const VehicleModel model = models[VehicleIndex(number, static_cast<int>(models.size()))];
      if (model == VehicleModel::kTwoD) continue;
      const std::string key = "detail_vehicles" + ListIndex(i);
      warnings.push_back({key, key + " is " + std::to_string(number) + ", a vehicle of the " + ModelName(model) +
                                   " model, which has no details"});
    }
  }
  if (!train.consist.empty()) WarnOfAdhesionLimit(scenario, warnings);
  if (scenario.brake && scenario.pressure_table.empty()) {
    std::vector<std::size_t> index;
    const std::vector<BrakeCommand> timed = TimedBrakeCommands(scenario.commands, &index);
    for (const Warning& warning : scenario.brake->Warnings(timed, train.VehicleCount()))
      warnings.push_back({RenumberedCommands(warning.key, index), RenumberedCommands(warning.text, index)});
  }
  if (!scenario.pressure_table.empty()) {
    const std::string unused = " not used: the pressures come from pressure_table";
    if (scenario.brake) warnings.push_back({"brake", "brake is" + unused});
    if (train.connection.strength_n > 0.0) {
      warnings.push_back({"train.connection.strength_n",
                          "the brake pipe stays closed where a connection breaks: the pressures come from "
                          "pressure_table"});
    }
    const auto of_brake = std::count_if(scenario.commands.begin(), scenario.commands.end(),
                                        [](const DriverCommand& command) { return command.IsOfTrainBrake(); });
    if (of_brake > 0) {
      warnings.push_back(
          {"commands", "commands of the brake (" + Counted(static_cast<std::size_t>(of_brake)) + ") are" + unused});
    }
  }
  return warnings;
}

}  // namespace train_dynamics
