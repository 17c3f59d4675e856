#include "train_dynamics/train/driver_command.h"

#include "train_dynamics/track/track.h"

namespace train_dynamics {

const char* NameOf(DriverCommandKind kind) {
  for (const auto& [name, known] : kDriverCommandKinds) {
    if (known == kind) return name;
  }
  return "";
}

BrakeCommand DriverCommand::OfBrake(double at_s) const {
  const BrakeCommandKind of_brake = kind == DriverCommandKind::kApply       ? BrakeCommandKind::kApply
                                    : kind == DriverCommandKind::kEmergency ? BrakeCommandKind::kEmergency
                                                                            : BrakeCommandKind::kRelease;
  return {at_s, of_brake, reduction_kpa};
}

LocomotiveCommand DriverCommand::OfLocomotives(double at_s) const {
  const LocomotiveCommandKind of_locomotives =
      kind == DriverCommandKind::kThrottle ? LocomotiveCommandKind::kThrottle : LocomotiveCommandKind::kDynamicBrake;
  return {at_s, of_locomotives, notch, vehicles};
}

LocomotiveBrakeCommand DriverCommand::OfLocomotiveBrakes(double at_s) const {
  return kind == DriverCommandKind::kBailOff
             ? LocomotiveBrakeCommand{at_s, LocomotiveBrakeCommandKind::kBailOff, 0.0, vehicles}
             : LocomotiveBrakeCommand{at_s, LocomotiveBrakeCommandKind::kIndependent, pressure_kpa, vehicles};
}

std::string DriverCommand::Text() const {
  const std::string name = NameOf(kind);
  if (kind == DriverCommandKind::kApply) return name + " " + ShortestDecimal(reduction_kpa) + " kPa";
  if (kind == DriverCommandKind::kIndependentBrake) return name + " " + ShortestDecimal(pressure_kpa) + " kPa";
  if (IsOfRail())
    return name + " " + ShortestDecimal(friction_coefficient) + " from " + ShortestDecimal(from_m) + " to " +
           ShortestDecimal(to_m) + " m";
  return IsOfLocomotives() ? name + " " + ShortestDecimal(notch) : name;
}

bool ActsOn(const DriverCommand& command, const ConsistGroupParams& group) {
  if (command.IsOfTrainBrake() || command.IsOfRail()) return false;
  return group.vehicle.traction || (group.locomotive && command.IsOfLocomotiveBrakes());
}

std::vector<BrokenRule> JudgePatch(const FrictionPatchParams& patch, const std::string& key, const TrackParams& track) {
  std::vector<BrokenRule> broken;
  const auto judge = [&](const char* name, double at_m) {
    if (IsWithinRamp(track, at_m))
      broken.push_back({key + "." + name, "must not lie within a ramp between surfaces of the track", {"track"}});
  };
  judge("from_m", patch.from_m);
  judge("to_m", patch.to_m);
  return broken;
}

std::string RuleOfPatches() {
  return "must not be friction once more: a run takes " + std::to_string(kMostPatchesOnTheWay) +
         " patches of rail on its way";
}

std::vector<DriverCommand> WithVehicles(std::vector<DriverCommand> commands, const TrainParams& train) {
  for (DriverCommand& command : commands) {
    if (command.group.empty()) continue;
    int first = 1;
    for (const ConsistGroupParams& group : train.consist) {
      const bool obeys = group.name == command.group && ActsOn(command, group);
      for (int i = 0; obeys && i < group.count; ++i) command.vehicles.push_back(first + i);
      first += group.count;
    }
    if (!command.vehicles.empty()) command.group.clear();
  }
  return commands;
}

std::vector<BrakeCommand> TimedBrakeCommands(const std::vector<DriverCommand>& commands,
                                             std::vector<std::size_t>* index) {
  std::vector<BrakeCommand> timed;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].IsOfTrainBrake() || !commands[i].time_s) continue;
    timed.push_back(commands[i].OfBrake(*commands[i].time_s));
    if (index != nullptr) index->push_back(i);
  }
  return timed;
}

std::vector<LocomotiveCommand> TimedLocomotiveCommands(const std::vector<DriverCommand>& commands) {
  std::vector<LocomotiveCommand> timed;
  for (const DriverCommand& command : commands) {
    if (command.IsOfLocomotives() && command.time_s) timed.push_back(command.OfLocomotives(*command.time_s));
  }
  return timed;
}

std::string RenumberedCommands(const std::string& text, const std::vector<std::size_t>& index) {
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

std::vector<LocomotiveBrakeCommand> TimedLocomotiveBrakeCommands(const std::vector<DriverCommand>& commands) {
  std::vector<LocomotiveBrakeCommand> timed;
  for (const DriverCommand& command : commands) {
    if (command.IsOfLocomotiveBrakes() && command.time_s) timed.push_back(command.OfLocomotiveBrakes(*command.time_s));
  }
  return timed;
}

}  // namespace train_dynamics
