#pragma once

#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// What the valve between the brake's supply and the cylinder of one wheelset does.
enum class ValveState {
  kFill,  ///< the cylinder follows the supply
  kHold,  ///< it keeps its air
  kVent   ///< it empties to the atmosphere
};

/// A valve of wheel-slide protection with the cylinder behind it.
struct CylinderValveParams {
  double delay_s = 0.030;
  double fill_time_constant_s = 0.25;
  double vent_time_constant_s = 0.10;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("delay_s", delay_s, kNonNegative, "from the controller's command to the valve's movement [A]");
    v.Number("fill_time_constant_s", fill_time_constant_s, kPositive,
             "time constant with which the cylinder fills [A]");
    v.Number("vent_time_constant_s", vent_time_constant_s, kPositive,
             "time constant with which the cylinder vents [A]");
  }
};

/// The same for a step of dt:
///
///   fill: p' = (p_s - p) / T_fill     hold: p' = 0     vent: p' = -p / T_vent
///
/// solved exactly for a supply pressure p_s that is held over the step. The air that is vented is not taken from the
/// reservoir [A].
class CylinderValve {
 public:
  CylinderValve(const CylinderValveParams& params, double dt)
      : fills_(1.0 - Exp(-dt / params.fill_time_constant_s)), keeps_(Exp(-dt / params.vent_time_constant_s)) {}

  /// The cylinder's pressure at the end of the step [Pa]. @param pressure_pa  at its start
  double Next(ValveState state, double pressure_pa, double supply_pa) const {
    switch (state) {
      case ValveState::kVent:
        return keeps_ * pressure_pa;
      case ValveState::kHold:
        return pressure_pa;
      default:
        return pressure_pa + fills_ * (supply_pa - pressure_pa);
    }
  }

 private:
  double fills_, keeps_;
};

}  // namespace train_dynamics
