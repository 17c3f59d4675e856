#include "train_dynamics/train/breakaway_loads.h"

#include <cmath>
#include <limits>

#include "train_dynamics/resistance/propulsion.h"

namespace train_dynamics {
namespace {

constexpr double kStanding = 1e-3;  // [m/s]

}  // namespace

BreakawayLoads::BreakawayLoads(const Consist& consist) {
  bool any = false;
  for (int i = 0; i < consist.vehicles(); ++i) {
    const VehicleParams& vehicle = consist.vehicle(i);
    const auto& breakaway = vehicle.propulsion_resistance.breakaway;
    any |= breakaway.has_value();
    resistance_n_.push_back(breakaway ? BreakawayResistance(*breakaway, vehicle.TotalMass(), vehicle.Wheelsets())
                                      : 0.0);
    distance_m_.push_back(breakaway ? breakaway->distance_m : 0.0);
  }
  if (any) stood_at_m_.assign(resistance_n_.size(), -std::numeric_limits<double>::infinity());
}

void BreakawayLoads::Evaluate(const std::vector<double>& head_displacement_m,
                              const std::vector<double>& head_velocity_mps, LoadArrays& loads) {
  if (empty()) return;
  bool any = false;
  loads.breakaway_resistance_n.resize(stood_at_m_.size());
  for (std::size_t i = 0; i < stood_at_m_.size(); ++i) {
    if (std::abs(head_velocity_mps[i]) <= kStanding) stood_at_m_[i] = head_displacement_m[i];
    const bool starts = std::abs(head_displacement_m[i] - stood_at_m_[i]) < distance_m_[i];
    loads.breakaway_resistance_n[i] = starts ? resistance_n_[i] : 0.0;
    any |= starts;
  }
  if (!any) loads.breakaway_resistance_n.clear();
}

}  // namespace train_dynamics
