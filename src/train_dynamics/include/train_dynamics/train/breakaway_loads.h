#pragma once

#include <vector>

#include "train_dynamics/train/consist.h"
#include "train_dynamics/vehicle/vehicle_loads.h"

namespace train_dynamics {

/// The resistance of bearings on vehicles that start (BreakawayParams).
///
/// A vehicle starts from the place where its coupler heads last moved at no more than 1 mm/s at an exchange's start,
/// until it is `distance_m` away from it, in either direction.
class BreakawayLoads {
 public:
  explicit BreakawayLoads(const Consist& consist);

  bool empty() const { return stood_at_m_.empty(); }

  /// Sets the loads over an exchange: an empty array where no vehicle starts.
  /// @param head_displacement_m, head_velocity_mps  [vehicle] of the coupler heads, at the exchange's start
  void Evaluate(const std::vector<double>& head_displacement_m, const std::vector<double>& head_velocity_mps,
                LoadArrays& loads);

  /// Calls function(number) for each number that further loads depend on.
  template <class Function>
  void ForEachField(Function&& function) {
    for (double& place_m : stood_at_m_) function(place_m);
  }

 private:
  std::vector<double> resistance_n_, distance_m_;  ///< [vehicle]; 0 where it has none
  std::vector<double> stood_at_m_;  ///< [vehicle] displacement where it last stood, -inf: nowhere; empty: none has any
};

}  // namespace train_dynamics
