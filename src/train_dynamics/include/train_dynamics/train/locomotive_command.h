#pragma once

#include <string>
#include <vector>

#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/train/consist.h"

namespace train_dynamics {

enum class LocomotiveCommandKind { kThrottle, kDynamicBrake };

/// What the driver does with throttle and dynamic brake, and when. Each cancels the other.
struct LocomotiveCommand {
  double time_s = kRequired;
  LocomotiveCommandKind kind = LocomotiveCommandKind::kThrottle;
  double notch = kRequired;
  std::vector<int> vehicles;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("time_s", time_s, kNonNegative, "when the command is given");
    v.Choice("kind", kind,
             {{"throttle", LocomotiveCommandKind::kThrottle}, {"dynamic_brake", LocomotiveCommandKind::kDynamicBrake}},
             "throttle or dynamic_brake; each cancels the other");
    v.Number("notch", notch, Range{0.0, 100.0, false, false}, "0: off");
    v.Integers("vehicles", vehicles, Range{-100000, 100000, false, false},
               "locomotives that obey, from 1, or from -1 for the last; none: all");
  }

  /// The demand on the addressed locomotives from then on.
  NotchCommand Notches() const {
    return kind == LocomotiveCommandKind::kThrottle ? NotchCommand{notch, 0.0} : NotchCommand{0.0, notch};
  }
};

/// The broken rules between a command and the train: each vehicle named must be a locomotive and have the notch.
/// @param key  of the command, such as "commands[2]"
std::vector<BrokenRule> JudgeLocomotiveCommand(const LocomotiveCommand& command, const std::string& key,
                                               const TrainParams& train);

/// The same for a command of the locomotives' own brakes: each vehicle named must be a locomotive, its brake must reach
/// the pressure, and a bail-off needs cylinders to empty.
std::vector<BrokenRule> JudgeLocomotiveBrakeCommand(const LocomotiveBrakeCommand& command, const std::string& key,
                                                    const TrainParams& train, const BrakeSystemParams& brake);

}  // namespace train_dynamics
