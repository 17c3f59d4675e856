#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace train_dynamics {

/// Value at `at` of the straight lines between points; beyond the first and the last point, their values.
///
/// @param x  ascending abscissae, at least one
/// @param y  as many ordinates
inline double InterpolateLinearly(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto next = std::upper_bound(x.begin(), x.end(), at);
  if (next == x.begin()) return y.front();
  if (next == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(next - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * ((at - x[i - 1]) / (x[i] - x[i - 1]));
}

/// Whether each number is larger than the one before.
inline bool IsAscending(const std::vector<double>& x) {
  return std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end();
}

}  // namespace train_dynamics
