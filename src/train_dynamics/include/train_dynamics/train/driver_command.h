#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/brake/brake_command.h"
#include "train_dynamics/brake/locomotive_brakes.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/parameters.h"
#include "train_dynamics/track/friction_map.h"
#include "train_dynamics/train/locomotive_command.h"

namespace train_dynamics {

struct TrackParams;

/// A condition that is met during the run. All keys that are given must hold at once.
struct ConditionParams {
  std::optional<double> position_m;
  std::optional<double> speed_above_kmh, speed_below_kmh;
  bool standing = false;
  double delay_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite,
             "the centre of the first vehicle is there, or has passed it, either way");
    v.Number("speed_above_kmh", speed_above_kmh, kNonNegative, "the train's mean speed is above, either way");
    v.Number("speed_below_kmh", speed_below_kmh, kPositive, "the train's mean speed is below, either way");
    v.Flag("standing", standing, "the mean speed is at most 1 mm/s, or has just changed its sign");
    v.Number("delay_s", delay_s, kNonNegative, "delay after the condition holds");
    v.Check(position_m || speed_above_kmh || speed_below_kmh || standing, "position_m",
            "must be given, or else speed_above_kmh, speed_below_kmh or standing",
            {"speed_above_kmh", "speed_below_kmh", "standing"});
    v.Check(!speed_above_kmh || !speed_below_kmh || *speed_above_kmh < *speed_below_kmh, "speed_above_kmh",
            "must be below speed_below_kmh, or both never hold", {"speed_below_kmh"});
  }
};

enum class DriverCommandKind {
  kApply,
  kEmergency,
  kRelease,
  kThrottle,
  kDynamicBrake,
  kIndependentBrake,
  kBailOff,
  kFriction
};

inline constexpr std::initializer_list<std::pair<const char*, DriverCommandKind>> kDriverCommandKinds = {
    {"apply", DriverCommandKind::kApply},
    {"emergency", DriverCommandKind::kEmergency},
    {"release", DriverCommandKind::kRelease},
    {"throttle", DriverCommandKind::kThrottle},
    {"dynamic_brake", DriverCommandKind::kDynamicBrake},
    {"independent_brake", DriverCommandKind::kIndependentBrake},
    {"bail_off", DriverCommandKind::kBailOff},
    {"friction", DriverCommandKind::kFriction}};

const char* NameOf(DriverCommandKind kind);

/// What the driver does, and when: at a time, when a condition has come true, or at an exchange (of a recorded run).
struct DriverCommand {
  std::optional<double> time_s;
  DriverCommandKind kind = DriverCommandKind::kApply;
  double reduction_kpa = kRequired;
  double notch = kRequired;
  double pressure_kpa = kRequired;
  double from_m = kRequired, to_m = kRequired, friction_coefficient = kRequired;
  std::vector<int> vehicles;
  std::string group;
  std::optional<ConditionParams> when;
  std::optional<double> exchange;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("time_s", time_s, kNonNegative, "when the command is given; or else when, or exchange");
    v.Group("when", when, "condition upon which the command is given");
    v.Number("exchange", exchange, Range{0.0, 1e12, false, false},
             "number of the exchange at whose start it is given: of commands that were given to a running train");
    v.Choice("kind", kind, kDriverCommandKinds,
             "apply, emergency, release: the brake of the train; throttle, dynamic_brake, independent_brake, "
             "bail_off: locomotives; friction: a patch of rail comes, which is none of a driver's commands");
    if (kind == DriverCommandKind::kApply)
      v.Number("reduction_kpa", reduction_kpa, kPositive, "total reduction of the brake pipe's pressure");
    if (IsOfLocomotives())
      v.Number("notch", notch, Range{0.0, 100.0, false, false},
               "of throttle or dynamic brake; 0: off; each cancels the other");
    if (kind == DriverCommandKind::kIndependentBrake)
      v.Number("pressure_kpa", pressure_kpa, kNonNegative,
               "of the locomotives' cylinders by their own brake; 0: released");
    if (IsOfRail()) {
      v.Number("from_m", from_m, kFinite, "position at which the patch of rail begins");
      v.Number("to_m", to_m, kFinite, "position at which it ends");
      v.Check(from_m < to_m, "to_m", "must be greater than from_m", {"from_m"});
      v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false},
               "mu0 of the patch from then on; the rest of the adhesion is that of the vehicles");
    }
    if (IsOfLocomotives() || IsOfLocomotiveBrakes()) {
      v.Integers("vehicles", vehicles, Range{-100000, 100000, false, false},
                 "locomotives that obey, from 1, or from -1 for the last; none: all, or those of group");
      v.Text("group", group, "name of the groups of the consist whose locomotives obey, in place of vehicles");
      v.Check(group.empty() || vehicles.empty(), "group", "must not stand beside vehicles", {"vehicles"});
    }
    const int times = (time_s ? 1 : 0) + (when ? 1 : 0) + (exchange ? 1 : 0);
    v.Check(times > 0, "time_s", "must be given, or else when (a condition)", {"when", "exchange"});
    v.Check(times < 2, "time_s", "must not be given beside when or exchange: a command has one time",
            {"when", "exchange"});
  }

  /// Throttle and dynamic brake.
  bool IsOfLocomotives() const {
    return kind == DriverCommandKind::kThrottle || kind == DriverCommandKind::kDynamicBrake;
  }
  /// Of the locomotives' own brakes.
  bool IsOfLocomotiveBrakes() const {
    return kind == DriverCommandKind::kIndependentBrake || kind == DriverCommandKind::kBailOff;
  }
  bool IsOfTrainBrake() const { return !IsOfLocomotives() && !IsOfLocomotiveBrakes() && !IsOfRail(); }
  /// A patch of rail, whose surface no driver commands.
  bool IsOfRail() const { return kind == DriverCommandKind::kFriction; }
  /// That patch. Only for a command of this kind.
  FrictionPatchParams OfRail() const { return {from_m, to_m, friction_coefficient, {}, {}}; }
  /// This command for the train's brake, given at a time. Only for commands of that brake.
  BrakeCommand OfBrake(double at_s) const;
  /// This command for the locomotives, given at a time. Only for commands of locomotives.
  LocomotiveCommand OfLocomotives(double at_s) const;
  /// This command for the locomotives' own brakes, given at a time. Only for commands of these.
  LocomotiveBrakeCommand OfLocomotiveBrakes(double at_s) const;
  /// As "apply 50 kPa" or "throttle 8".
  std::string Text() const;
};

/// Whether a command of locomotives acts on the vehicles of a group: throttle and dynamic brake on those with traction,
/// the brakes of locomotives on all locomotives.
bool ActsOn(const DriverCommand& command, const ConsistGroupParams& group);

/// The rules between a patch of rail that is added during the run and the track under it.
/// @param key  of the command
std::vector<BrokenRule> JudgePatch(const FrictionPatchParams& patch, const std::string& key, const TrackParams& track);
/// The rule that a run takes at most kMostPatchesOnTheWay of them, as a sentence about `kind`.
std::string RuleOfPatches();

/// The same commands, with the numbers of the locomotives of the group that they name, if it has any.
std::vector<DriverCommand> WithVehicles(std::vector<DriverCommand> commands, const TrainParams& train);
/// The commands with a time, for the train's brake, in the order of the list.
/// @param index  of each in the list; null: not wanted
std::vector<BrakeCommand> TimedBrakeCommands(const std::vector<DriverCommand>& commands,
                                             std::vector<std::size_t>* index = nullptr);

/// A text with commands[k], where k counts the commands of the brake only, renumbered by the whole list.
/// @param index  of each in the list, as TimedBrakeCommands gives it
std::string RenumberedCommands(const std::string& text, const std::vector<std::size_t>& index);
/// The commands with a time, for the locomotives, in the order of the list.
std::vector<LocomotiveCommand> TimedLocomotiveCommands(const std::vector<DriverCommand>& commands);
/// The commands with a time, for the locomotives' own brakes, in the order of the list.
std::vector<LocomotiveBrakeCommand> TimedLocomotiveBrakeCommands(const std::vector<DriverCommand>& commands);

}  // namespace train_dynamics
