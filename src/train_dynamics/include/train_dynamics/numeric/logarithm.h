#pragma once

#include <limits>

#include "train_dynamics/numeric/elementary.h"

namespace train_dynamics {

/// Natural logarithm, with the same bits for `double` and for lanes (see numeric/elementary.h). Error below 1.5e-15,
/// relative where |ln x| > 1 and absolute elsewhere, for normal x > 0; Log(1) is exactly 0. For other x it is NaN.
///
/// x = 2^n m with m in [1/sqrt 2, sqrt 2]:  ln x = n ln 2 + 2 artanh u,  u = (m - 1) / (m + 1), |u| <= 0.1716; the
/// series of artanh u up to u^21 leaves 1e-17 of it.
template <class T>
constexpr T Log(T x) {
  constexpr double kLn2 = 0.6931471805599453;
  const BitsOf<T> bits = ToBits(x);
  const BitsOf<T> exponent = bits >> 52;
  // The low bits of 2^52 + e are e.
  const T whole = FromBits(exponent + ToBits(T(4503599627370496.0))) - 4503599627370496.0;
  const T in_one_two = FromBits(((bits << 12) >> 12) + ToBits(T(1.0)));  // [1, 2)
  const auto is_high = in_one_two > 1.4142135623730951;
  const T m = Select(is_high, 0.5 * in_one_two, in_one_two);
  const T n = Select(is_high, whole - 1022.0, whole - 1023.0);
  const T u = (m - 1.0) / (m + 1.0), z = u * u;
  const T series = Polynomial(z, 1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0,
                              1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0);
  const auto is_normal = (x >= std::numeric_limits<double>::min()) & (x <= std::numeric_limits<double>::max());
  return Select(is_normal, n * kLn2 + 2.0 * (u * series), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace train_dynamics
