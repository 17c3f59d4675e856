#pragma once

#include <cstdint>
#include <vector>

#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"

namespace train_dynamics {

/// A search for undesired emergencies: random commands, none of which may cause an emergency.
struct EmergencySearch {
  int trials = 10;
  std::uint32_t seed = 1;
  int cells_per_vehicle = 2;
  double mean_pause_s = 20.0;  ///< between commands; each pause is uniform from 0.1 s to twice this
  int commands = 6;            ///< of each trial; the same time passes after the last
};

/// A trial in which a valve went into emergency.
struct UndesiredEmergency {
  int trial, vehicle;  ///< from 1; the first vehicle
  double time_s;
  double initial_pressure_kpa;
  std::vector<BrakeCommand> commands;  ///< until then
};

/// Drives a train's brake by random service applications (reductions from 15 kPa to 30 kPa more than full service),
/// steps back, where all valves allow them, and releases. Every third trial begins with an empty pipe or one between
/// empty and charged: the train recharges. Hoses hold; sources have no commands of their own; angle cocks and radio
/// stay as they are. The same seed gives the same trials on every machine.
std::vector<UndesiredEmergency> FindUndesiredEmergencies(PneumaticBrakeParams params,
                                                         const std::vector<double>& vehicle_length_m,
                                                         const EmergencySearch& search);

}  // namespace train_dynamics
