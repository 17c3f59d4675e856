#pragma once

#include <string>
#include <vector>

#include "train_brake_rviz/board/axis.h"
#include "train_brake_rviz/board/palette.h"
#include "train_brake_rviz/board/snapshot.h"

namespace train_brake_rviz {

/// What the vehicles are coloured by.
struct Quantity {
  std::string name;  ///< by which it is chosen
  std::string label, unit;
  double per_si;                                   ///< value in `unit` of one SI unit
  double least_limit;                              ///< end of its scale while all values are small, in `unit`
  bool diverging;                                  ///< has a sign: the scale is symmetric about zero
  std::string negative, positive;                  ///< names of the ends, if it has a sign
  std::vector<double> (*values)(const Snapshot&);  ///< [vehicle] in SI units
};

/// coupler_force, pressure, pipe_pressure, slip, acceleration.
const std::vector<Quantity>& Quantities();

/// Null if there is none of that name.
const Quantity* FindQuantity(const std::string& name);

/// Of the couplers in front of and behind each vehicle the force that is larger in size [N].
std::vector<double> VehicleCouplerForces(const Snapshot& snapshot);

/// Colour of a value in `quantity.unit` on a scale that ends at `limit`.
Color ColorOf(const Quantity& quantity, double value, double limit);

}  // namespace train_brake_rviz
