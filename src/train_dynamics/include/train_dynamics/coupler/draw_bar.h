#pragma once

#include "train_dynamics/spring/linear_spring_damper.h"

namespace train_dynamics {

/// A draw-bar between two vehicles: bilateral, linear, without slack.
///
///   F = k q + c q'  [N], tension positive;  q the extension [m]
using DrawBarParams = LinearSpringDamper;

}  // namespace train_dynamics
