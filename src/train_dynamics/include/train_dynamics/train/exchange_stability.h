#pragma once

#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// The longest exchange interval H at which a connection is numerically stable [s].
///
/// Its force is evaluated once per interval, at the predicted middle, and held. In the least stable motion,
/// neighbours of a long train move against each other, each coupler head of mass m between two equal connections of
/// tangent stiffness k and damping c, which act on its displacement x with a factor of four:
///
///   v1 = v0 - (4 H / m) (k (x0 + H/2 v0) + c v0),   x1 = x0 + H/2 (v0 + v1)
///
/// whose trace is 2 - 4 k H^2 / m - 4 c H / m and whose determinant 1 - 4 c H / m. Neither mode grows while
///
///   k H^2 + 2 c H < m
///
/// with k and c of the law's tangent at kLargeCouplerForce (TangentAt in coupler/*.h).
///
/// The friction's slope falls as soon as the gears move, so what grows is bounded at first: whole trains broke down at
/// 1 to 1.8 times this interval (docs/validation.md). Left out: solid stops, different vehicles side by side.
///
/// @param head_mass_kg  see CouplerHeadMass
double LongestStableExchange(const ConnectionParams& connection, double head_mass_kg);

/// The effective mass of a coupler head against a fast force [kg]: the vehicle's inertia in LTD; in the 2D model that
/// of the carbody, which yields in x and in pitch: 1 / (1/m + h^2/I), h the head's height over its centre of gravity.
double CouplerHeadMass(const VehicleParams& vehicle, VehicleModel model);

/// The lightest coupler head of a scenario's train [kg].
double LightestCouplerHead(const ScenarioParams& scenario);

}  // namespace train_dynamics
