#pragma once

#include <array>
#include <cmath>

namespace train_dynamics {

struct SinCos {
  double sin, cos;
};

/// Sine and cosine of an angle in turns (1 turn = 2 pi rad), the same bits on every machine.
///
/// Reduction to an eighth of a turn, then the Taylor series to x^16; absolute error below 2e-16. Exact at
/// multiples of a quarter turn; NaN for what is not finite.
inline SinCos SinCosTurns(double turns) {
  const double quarter = std::round(4.0 * turns);
  const double x = 6.283185307179586476925 * (turns - 0.25 * quarter);
  const double x2 = x * x;
  double sin = 0.0, cos = 0.0;
  for (int k = 16; k >= 2; k -= 2) {
    sin = x2 / (-(k + 1.0) * k) * (1.0 + sin);
    cos = x2 / (-k * (k - 1.0)) * (1.0 + cos);
  }
  sin = x * (1.0 + sin);
  cos = 1.0 + cos;
  const double quarter_of_four = quarter - 4.0 * std::floor(0.25 * quarter);
  if (quarter_of_four == 1.0) return {cos, -sin};
  if (quarter_of_four == 2.0) return {-sin, -cos};
  if (quarter_of_four == 3.0) return {-cos, sin};
  return {sin, cos};
}

/// Sine and cosine of an angle in degrees.
inline SinCos SinCosDegrees(double degrees) { return SinCosTurns(degrees / 360.0); }

}  // namespace train_dynamics
