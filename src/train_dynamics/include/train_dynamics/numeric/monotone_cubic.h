#pragma once

#include <vector>

namespace train_dynamics {

/// Value at `at` of the monotone cubic (slopes of Fritsch and Butland) through the points: smooth, without
/// overshoot.
///
/// @param x   at least 4 ascending abscissae
/// @param y   as many ordinates
/// @param at  in [x.front(), x.back()]
/// @throws std::domain_error otherwise.
double MonotoneCubic(const std::vector<double>& x, const std::vector<double>& y, double at);

}  // namespace train_dynamics
