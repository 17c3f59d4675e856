#pragma once

namespace train_dynamics {

/// Central difference of an energy that is a parabola between its kinks: exact but for rounding, about
/// 1e-16 x 1e5 J / 1e-5 m = 1e-6 N, unless a kink lies within the step.
template <class Energy>
double Slope(const Energy& energy, double d) {
  constexpr double kStep = 1e-5;
  return (energy(d + kStep) - energy(d - kStep)) / (2.0 * kStep);
}

}  // namespace train_dynamics
