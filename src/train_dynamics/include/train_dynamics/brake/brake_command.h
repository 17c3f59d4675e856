#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

enum class BrakeCommandKind { kApply, kEmergency, kRelease };

/// What the driver does with the brake, and when.
struct BrakeCommand {
  double time_s = kRequired;
  BrakeCommandKind kind = BrakeCommandKind::kApply;
  double reduction_kpa = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("time_s", time_s, kNonNegative, "when the command is given");
    v.Choice("kind", kind,
             {{"apply", BrakeCommandKind::kApply},
              {"emergency", BrakeCommandKind::kEmergency},
              {"release", BrakeCommandKind::kRelease}},
             "apply, emergency or release");
    if (kind == BrakeCommandKind::kApply)
      v.Number("reduction_kpa", reduction_kpa, kPositive, "total reduction of the brake pipe's pressure");
  }
};

}  // namespace train_dynamics
