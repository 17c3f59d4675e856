#pragma once

#include <array>

namespace train_dynamics {

/// The elements of a vehicle that take energy out of it. Each has an account in the energy ledger.
enum Dissipation {
  kWheelRailCreep,
  kWheelRailNormal,
  kAdaptorPads,
  kFrictionWedges,
  kBolsterGuides,
  kCentrePlates,
  kBrakeShoes,
  kDynamicBrake,
  kRollingResistance,
  kCurvingResistance,
  kAirDrag,
  kNestDampers,
  kDissipations  ///< their number
};

inline constexpr std::array<const char*, kDissipations> kDissipationNames = {
    "wheel_rail_creep",   "wheel_rail_normal",  "adaptor_pads", "friction_wedges",
    "bolster_guides",     "centre_plates",      "brake_shoes",  "dynamic_brake",
    "rolling_resistance", "curving_resistance", "air_drag",           "nest_dampers"};

/// Work done on and by a vehicle since the start [J].
template <class T>
struct VehicleWork {
  std::array<T, kDissipations> dissipated{};  ///< by element, >= 0 but for the noise of wedges at rest
  T gravity{};                                ///< done on the vehicle by the grade
  T traction{};                               ///< done on the vehicle by its traction force
};

/// What acts on a vehicle from outside its own equations; held over an exchange interval.
///
/// Paper Eq 1: F_c1 + F_c2 + F_t + F_db + F_ab + F_cr; propulsion resistance and gravity are the vehicle's
/// own.
template <class T>
struct VehicleLoads {
  T front_coupler_n{};       ///< tension positive: pulls forward
  T rear_coupler_n{};        ///< tension positive: pulls backward
  T cylinder_pressure_pa{};  ///< of the air brake
  T traction_n{};            ///< at the wheel rims, forward positive
  T dynamic_brake_n{};       ///< at the wheel rims, >= 0, opposes the rotation
  T curving_resistance_n{};  ///< >= 0, opposes the motion
};

}  // namespace train_dynamics
