#pragma once

#include <string>
#include <vector>

#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"

namespace train_dynamics {

/// One result of the air-brake tests that are made before a train runs.
struct AirTestResult {
  std::string test;
  double value;
  std::string unit;
  std::string rule;  ///< in words, with its source
  bool passed;
};

/// The tests of a test track, each on the train at rest, with this brake:
///
///   single car         one vehicle with the second vehicle's valve: application of 70 kPa, its hold, its release
///   charging           the empty train until the tail has 95 % of the head's goal
///   leakage, gradient  of the charged train: flow that the driver's valve feeds, head less tail, fall in a minute of
///                      lap service
///   service            full service and release: last cylinder, and whether any valve went into emergency
///   emergency          whether all cylinders filled, and, of 50 vehicles and more, the speed of its front from
///                      vehicle 21, or a quarter of the train, to the end
///
/// Rules [M] from memory of 49 CFR 232.205 (5 psi/min; 60 ft3/min and 15 psi) and UIC 540 (250 m/s); the rest [A].
/// ECP valves answer the train line: their times are those of the goal.
std::vector<AirTestResult> TestAirBrake(const PneumaticBrakeParams& params,
                                        const std::vector<double>& vehicle_length_m);

}  // namespace train_dynamics
