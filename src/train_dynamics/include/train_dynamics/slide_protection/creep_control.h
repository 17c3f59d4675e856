#pragma once

#include <algorithm>

#include "train_dynamics/parameters.h"
#include "train_dynamics/slide_protection/cylinder_valve.h"
#include "train_dynamics/slide_protection/wheel_reading.h"

namespace train_dynamics {

/// The controller `creep_control`.
struct CreepControlParams {
  double target_creepage = 0.05;
  double dead_band = 0.25;
  double prediction_s = 0.10;
  double least_slip_mps = 0.1;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("target_creepage", target_creepage, Range{0.0, 1.0, true, true},
             "s*, slip speed over the train's speed that the controller aims at");
    v.Number("dead_band", dead_band, Range{0.0, 1.0, false, true},
             "share of the target to either side within which the valve holds");
    v.Number("prediction_s", prediction_s, kNonNegative,
             "tau, by which it looks ahead: valve delay and part of the cylinder's lag");
    v.Number("least_slip_mps", least_slip_mps, kPositive, "least slip speed that it aims at");
  }
};

/// Regulates the slip speed to that of a creepage near the peak of the creep curve, looking ahead:
///
///   s_p = s + tau ds/dt,   s_g = max(s* v_ref, s_min)
///   vent   s_p > (1 + b) s_g     fill   s_p < (1 - b) s_g     hold   between
///
/// The peak's position depends on the rail and the speed; the target is a fixed parameter and does not track it.
struct CreepControl {
  CreepControlParams params;

  ValveState Decide(const WheelReading& wheel) const {
    const double ahead = wheel.Slip() + params.prediction_s * wheel.SlipRate();
    const double goal = std::max(params.target_creepage * wheel.reference_speed_mps, params.least_slip_mps);
    if (ahead > (1.0 + params.dead_band) * goal) return ValveState::kVent;
    return ahead < (1.0 - params.dead_band) * goal ? ValveState::kFill : ValveState::kHold;
  }
};

}  // namespace train_dynamics
