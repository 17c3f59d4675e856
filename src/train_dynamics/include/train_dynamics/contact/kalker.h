#pragma once

namespace train_dynamics {

/// Kalker's longitudinal creep coefficient c11 [-] of the linear theory.
///
/// Interpolated in Kalker's table: monotone cubic along a/b (b/a beyond the circle), quadratic through the
/// three tabulated Poisson ratios 0, 0.25, 0.5.
///
/// @param semi_axis_ratio  a/b, longitudinal over lateral, in [0.1, 10]
/// @param poisson_ratio    in [0, 0.5]
/// @throws std::domain_error outside these ranges.
/// Source: Kalker, On the rolling contact of two elastic bodies in the presence of dry friction, 1967.
double KalkerC11(double semi_axis_ratio, double poisson_ratio);

}  // namespace train_dynamics
