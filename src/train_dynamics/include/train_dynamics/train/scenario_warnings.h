#pragma once

#include <vector>

#include "train_dynamics/judgement.h"
#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// The warnings about a scenario that keeps its rules.
///
/// An exchange interval H that one of the connections does not stand: see LongestStableExchange. A smoothing speed v_e
/// of draft gears too steep for the step:
///
///   v_e < 2 F mu_s dt / (tan(phi) m)    F = 900 kN, m of the lightest vehicle
///
/// Besides: parts of the scenario that its models, or its pressure table, leaves unused.
std::vector<Warning> Warnings(const ScenarioParams& scenario);

}  // namespace train_dynamics
