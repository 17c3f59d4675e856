#pragma once

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Coefficient of friction between brake shoe and wheel tread.
struct ShoeFrictionParams {
  double standstill_friction_coefficient = kRequired;  ///< at v = 0
  double reference_speed_kmh = kRequired;              ///< V

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("standstill_friction_coefficient", standstill_friction_coefficient, kPositive);
    v.Number("reference_speed_kmh", reference_speed_kmh, kPositive);
  }
};

/// Shoe friction [-] at a speed [m/s], even in it (paper Eq 3):
///
///   mu_b = mu_0 (v + V) / (2 v + V),  v in km/h;  from mu_0 at rest down to mu_0 / 2
template <class T>
T ShoeFriction(const ShoeFrictionParams& p, T speed) {
  const T v_kmh = 3.6 * Abs(speed);
  return p.standstill_friction_coefficient * (v_kmh + p.reference_speed_kmh) /
         (2.0 * v_kmh + p.reference_speed_kmh);
}

/// What the brake shoes hang on, and with it what the torques on the wheelsets react on (2D model).
enum class BrakeReaction {
  kFrame,    ///< shoes on the bogie frame: it gets the opposite of the torque of each of its wheelsets
  kCarbody,  ///< shoes on the carbody; bearings, traction and dynamic brake react on the frame
  kNone      ///< the paper's simplification: all torques act on the wheelsets as if from outside
};

/// The speed of which the friction between shoe and tread is a function (2D model).
enum class FrictionSpeed {
  kTread,   ///< |omega r| of each wheelset
  kVehicle  ///< that of the carbody
};

/// Brake rigging of a vehicle: from cylinder pressure to the shoes' tangential force.
struct BrakeRiggingParams {
  double shoe_load_per_pressure_n_per_pa = kRequired;  ///< C, normal load of all shoes per cylinder pressure
  ShoeFrictionParams shoe_friction;
  BrakeReaction reaction = BrakeReaction::kFrame;
  FrictionSpeed friction_speed = FrictionSpeed::kTread;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("shoe_load_per_pressure_n_per_pa", shoe_load_per_pressure_n_per_pa, kNonNegative);
    v.Group("shoe_friction", shoe_friction);
    v.Choice("reaction", reaction,
             {{"frame", BrakeReaction::kFrame},
              {"carbody", BrakeReaction::kCarbody},
              {"none", BrakeReaction::kNone}});
    v.Choice("friction_speed", friction_speed,
             {{"tread", FrictionSpeed::kTread}, {"vehicle", FrictionSpeed::kVehicle}});
  }
};

/// Largest tangential force of all shoes of a vehicle [N]: C p mu_b(v). It opposes the wheels' rotation.
template <class T>
T ShoeForce(const BrakeRiggingParams& p, T cylinder_pressure_pa, T speed) {
  return p.shoe_load_per_pressure_n_per_pa * cylinder_pressure_pa * ShoeFriction(p.shoe_friction, speed);
}

}  // namespace train_dynamics
