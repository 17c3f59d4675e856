#pragma once

#include <algorithm>

/// What the controllers of wheels that slide or spin have in common: the wheel-slide protection of brakes and the slip
/// control of traction read the same sensors at a clock of the same kind.
///
/// A controller is a law with constant parameters, one of a closed set that its owner holds as a std::variant (see
/// slide_protection.h). It is asked every sampling period, wheelset by wheelset, with a WheelReading and its own memory
/// of that wheelset, and returns the demand on the actuator. It is independent of clock, vehicle and rail.
namespace train_dynamics {

/// What a controller reads of one wheelset at a sample. Speeds are positive in the vehicle's direction of travel.
struct WheelReading {
  double reference_speed_mps;          ///< v_ref, the controller's value of the vehicle's speed, >= 0
  double reference_acceleration_mps2;  ///< v_ref less that of the sample before, over the period; 0 at the first
  double wheel_speed_mps;              ///< u = r omega
  double wheel_acceleration_mps2;      ///< a, of u likewise
  double cylinder_pressure_pa;         ///< of the wheelset, >= 0

  double Slip() const { return reference_speed_mps - wheel_speed_mps; }  ///< s [m/s]; braking: positive
  double SlipRate() const { return reference_acceleration_mps2 - wheel_acceleration_mps2; }  ///< [m/s^2]
};

/// Source of a controller's reference speed.
enum class ReferenceSpeed {
  kTrue,      ///< the vehicle's true speed: ideal
  kEstimated  ///< v_ref <- max(max u_i, v_ref - a_max T_s), from the wheels alone
};

/// The next estimate of the reference speed [m/s].
/// @param fastest_wheel_mps  max over the wheelsets of |u|
/// @param before_mps         the estimate of the sample before; 0 at the first
inline double EstimatedReference(double fastest_wheel_mps, double before_mps, double largest_deceleration_mps2,
                                 double period_s) {
  return std::max(fastest_wheel_mps, before_mps - largest_deceleration_mps2 * period_s);
}

}  // namespace train_dynamics
