#pragma once

#include <algorithm>

#include "train_dynamics/parameters.h"
#include "train_dynamics/slide_protection/cylinder_valve.h"
#include "train_dynamics/slide_protection/wheel_reading.h"

namespace train_dynamics {

/// The thresholds of the controller `threshold_3state`; each slip threshold is the larger one of a share of the
/// reference speed and a speed.
struct Threshold3StateParams {
  double vent_slip_ratio = 0.12, vent_slip_mps = 1.0;
  double alert_slip_ratio = 0.03, alert_slip_mps = 0.3;
  double alert_deceleration_mps2 = 3.0;
  double hold_slip_ratio = 0.05, hold_slip_mps = 0.6;
  double hold_deceleration_mps2 = 0.5;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("vent_slip_ratio", vent_slip_ratio, kFraction,
             "slip over reference speed beyond which the valve vents, whatever the wheel does");
    v.Number("vent_slip_mps", vent_slip_mps, kNonNegative,
             "least slip for that; the larger one of the two thresholds holds, here and below");
    v.Number("alert_slip_ratio", alert_slip_ratio, kFraction,
             "slip over reference speed beyond which it vents if the wheel slows down at alert_deceleration_mps2");
    v.Number("alert_slip_mps", alert_slip_mps, kNonNegative, "least slip for that");
    v.Number("alert_deceleration_mps2", alert_deceleration_mps2, kNonNegative, "deceleration of the wheel for that");
    v.Number("hold_slip_ratio", hold_slip_ratio, kFraction,
             "slip over reference speed beyond which it holds, or vents if the wheel still slows down");
    v.Number("hold_slip_mps", hold_slip_mps, kNonNegative, "least slip for that");
    v.Number("hold_deceleration_mps2", hold_deceleration_mps2, kNonNegative,
             "deceleration from which the wheel counts as still slowing down");
    v.Check(hold_slip_ratio <= vent_slip_ratio, "hold_slip_ratio", "must be at most vent_slip_ratio");
    v.Check(hold_slip_mps <= vent_slip_mps, "hold_slip_mps", "must be at most vent_slip_mps");
  }
};

/// Thresholds on slip s = v_ref - u and on the wheel's acceleration a:
///
///   vent   s > max(0.12 v_ref, 1.0), or s > max(0.03 v_ref, 0.3) and a < -3.0,
///          or s > max(0.05 v_ref, 0.6) and a < -0.5
///   hold   else s > max(0.05 v_ref, 0.6)
///   fill   else                                                 [m/s, m/s^2; the defaults]
///
/// Defaults [A]: typical of such devices, not those of a real one (EN 15595, UIC 541-05 set tests for such devices; no
/// conformity is claimed).
struct Threshold3State {
  Threshold3StateParams params;

  ValveState Decide(const WheelReading& wheel) const {
    const double slip = wheel.Slip(), acceleration = wheel.wheel_acceleration_mps2;
    const auto beyond = [&](double ratio, double least_mps) {
      return slip > std::max(ratio * wheel.reference_speed_mps, least_mps);
    };
    if (beyond(params.vent_slip_ratio, params.vent_slip_mps)) return ValveState::kVent;
    if (acceleration < -params.alert_deceleration_mps2 && beyond(params.alert_slip_ratio, params.alert_slip_mps))
      return ValveState::kVent;
    if (!beyond(params.hold_slip_ratio, params.hold_slip_mps)) return ValveState::kFill;
    return acceleration < -params.hold_deceleration_mps2 ? ValveState::kVent : ValveState::kHold;
  }
};

}  // namespace train_dynamics
