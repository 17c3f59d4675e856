#pragma once

/// Limits beyond which a vehicle is outside the domain of every law.
namespace train_dynamics::state_limits {

inline constexpr double kSpeed = 300.0;      ///< of any body [m/s]
inline constexpr double kMovement = 1.0;     ///< of any body, up or down from the rail under it [m]
inline constexpr double kPitch = 0.5;        ///< of any body but a wheelset, from the rail under it [rad]
inline constexpr double kRotation = 3000.0;  ///< of a wheelset [rad/s]

}  // namespace train_dynamics::state_limits
