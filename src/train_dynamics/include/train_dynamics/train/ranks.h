#pragma once

#include <string>
#include <vector>

#include "train_dynamics/train/consist.h"

namespace train_dynamics {

/// A contiguous block of a train's vehicles that has a process of its own.
struct Rank {
  std::string name;  ///< of its node: VehicleName of its first vehicle
  int first = 0;     ///< index in the train, from 0
  int count = 0;
  bool is_external = false;  ///< its vehicles are moved by an external program
};

/// Deals the vehicles to ranks of about equal size: rank r has the vehicles [n r / ranks, n (r + 1) / ranks).
///
/// @param ranks  clamped to 1 ... vehicles
std::vector<Rank> SplitRanks(int vehicles, int ranks);

/// The groups of external vehicles, each the rank of its node.
std::vector<Rank> ExternalRanks(const TrainParams& train);

/// "wagon_007" for the vehicle of index 6 in a train of up to 999; wider in longer trains. Names sort as the
/// vehicles do.
std::string VehicleName(int vehicle, int vehicles);

/// "vehicle 7" or "vehicles 7-12": the vehicles of a rank for messages, numbered from 1.
std::string VehiclesText(const Rank& rank);

}  // namespace train_dynamics
