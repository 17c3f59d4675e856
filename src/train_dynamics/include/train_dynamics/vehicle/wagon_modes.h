#pragma once

#include <string>
#include <vector>

#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// One natural mode of the linearised wagon.
template <int kPerBogie = 2>
struct WagonMode {
  double frequency_hz;                         ///< |lambda| / (2 pi)
  double damping_ratio;                        ///< -Re(lambda) / |lambda|; 1 and more: creeps back without swinging
  BodyVector<double, kPerBogie> shape;         ///< real part, largest component 1 (metres and radians alike)
  BodyVector<double, kPerBogie> energy_share;  ///< share of each motion in the mode's kinetic energy, adding up to 1
};

/// The wagon linearised about its static equilibrium.
template <int kPerBogie = 2>
struct WagonModes {
  std::vector<WagonMode<kPerBogie>> modes;  ///< by rising frequency, rigid-body motions left out
  int rigid_body_modes;          ///< motions without a restoring force: forward travel and the wheels' rotation
  double largest_stable_step_s;  ///< beyond it the explicit part of the time step diverges
};

/// Natural frequencies, damping and shapes of a wagon at rest.
///
///   M q'' + C q' + K q = 0,   lambda from the first-order form (54 x 54 with two wheelsets per bogie)
///
/// K and C are the derivatives of the elements' forces at the equilibrium (their laws are piecewise linear
/// there). Wedges slide without friction; wheels roll without creep forces, which the time step treats
/// implicitly anyway. The largest stable step is that of the leapfrog with its dampers at the old rates,
/// found by bisection on the spectral radius of its amplification matrix.
template <int kPerBogie>
WagonModes<kPerBogie> AnalyseModes(const BogieVehicle<kPerBogie>& wagon);

}  // namespace train_dynamics
