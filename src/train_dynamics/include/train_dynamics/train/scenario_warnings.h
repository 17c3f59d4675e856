#pragma once

#include <vector>

#include "train_dynamics/judgement.h"
#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// Warnings about a valid scenario.
///
/// An exchange interval H at which one of the connections is unstable: see LongestStableExchange. A smoothing speed v_e
/// of draft gears that is too small for the step:
///
///   v_e < 2 F mu_s dt / (tan(phi) m)    F = 900 kN, m of the lightest vehicle
///
/// Also: parts of the scenario that its models or its pressure table leave unused.
std::vector<Warning> Warnings(const ScenarioParams& scenario);

}  // namespace train_dynamics
