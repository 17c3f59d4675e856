#pragma once

#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

/// Force of a one-sided contact [N], >= 0, pressing the two bodies apart.
///
///   N = max(0, k delta + c delta')  while delta > 0, else 0
///
/// No tension, hence no adhesive damping force on separation.
/// @param stiffness    k [N/m]      @param damping  c [Ns/m]
/// @param penetration  delta [m]    @param rate     delta' [m/s]
template <class T>
T OneSidedForce(double stiffness, double damping, T penetration, T rate) {
  return Select(penetration > T(0.0), Max(T(0.0), stiffness * penetration + damping * rate), T(0.0));
}

/// Elastic energy k delta^2 / 2 of a one-sided contact [J].
template <class T>
T OneSidedEnergy(double stiffness, T penetration) {
  const T closed = Max(T(0.0), penetration);
  return 0.5 * stiffness * closed * closed;
}

}  // namespace train_dynamics
