#pragma once

#include <limits>

#include "train_dynamics/numeric/scalar.h"

/// Exponential, decay, arc tangent and inverse cube root, with one sequence of operations for `double` and for lanes:
/// every machine, compiler and lane count gives the same bits, which no libm promises. Only + - * /, comparisons,
/// Select and integer shifts and adds occur; there is no table. (Contraction into fused multiply-adds must be off:
/// -ffp-contract=off.)
///
/// Errors, but that of Decay, are relative, in ulp: the spacing of doubles at the exact result. The bounds hold in
/// test/elementary_test.cpp; in brackets the largest error found in some 10^7 arguments each. NaN in gives NaN
/// out.
///
/// The polynomial coefficients are minimax for the RELATIVE error of the function: Remez exchange in 60-digit
/// arithmetic on the reduced interval, each coefficient then rounded to the nearest double. Those of Decay come from an
/// exchange in 50 digits that was stopped early: near minimax, not minimax.
namespace train_dynamics {

namespace detail {

template <class T>
constexpr T PairedHorner(T /*x*/, T /*x2*/, double c0) {
  return T(c0);
}
template <class T>
constexpr T PairedHorner(T x, T /*x2*/, double c0, double c1) {
  return c0 + c1 * x;
}
template <class T, class... Higher>
constexpr T PairedHorner(T x, T x2, double c0, double c1, Higher... higher) {
  return (c0 + c1 * x) + x2 * PairedHorner(x, x2, higher...);
}

}  // namespace detail

/// c0 + c1 x + c2 x^2 + ..., as Horner's rule in x^2 over the pairs (c0 + c1 x), (c2 + c3 x), ...: half as
/// long a chain of dependent operations as in x.
template <class T, class... Coefficients>
constexpr T Polynomial(T x, Coefficients... c) {
  return detail::PairedHorner(x, x * x, c...);
}

/// e^x. Error below 1 ulp (0.97) for x in [-708, 709.78]; Exp(0) is exactly 1.
/// Below -708 (e^x < 3.4e-308, where the normal numbers end) the result is 0; above 709.78 it is infinite.
template <class T>
constexpr T Exp(T x) {
  // Adding 1.5 * 2^52 rounds to a whole number and leaves it in the low bits of the sum.
  constexpr double kRounder = 6755399441055744.0;
  const T limited = Clamp(x, -708.0, 710.0);
  const T shifted = limited * 1.4426950408889634 + kRounder;  // x / ln 2
  const T n = shifted - kRounder;
  // ln 2 in two parts; the first has 40 bits, so that its product with n and r_high are exact.
  const T r_high = limited - n * 0.6931471805592082;
  const T r_low = n * 7.371002565167799e-13;
  const T r = r_high - r_low;
  // e^r = 1 + r + r^2 q(r), |r| <= ln(2) / 2; error of q: 2e-17 of e^r - 1.
  const T q = Polynomial(r, 0.5000000000000006, 0.16666666666666588, 0.041666666666576826, 0.008333333333389507,
                         0.0013888888931539443, 0.0001984126971908156, 2.480150530642488e-05, 2.7557407506399274e-06,
                         2.7626024203196394e-07, 2.5053774878777672e-08);
  const T power = 1.0 + (r_high + (r * r * q - r_low));
  // The exponent field of 2^(n-1), a normal number for every n that occurs, is n - 1 + 1023; the shift drops all of
  // `shifted` but n.
  const T half_scale = FromBits((ToBits(shifted) + 1022) << 52);
  return Select(x < -708.0, 0.0, (power + power) * half_scale);
}

/// e^-x for x >= 0, with a relative error below 2e-12 (1.8e-12): for laws of friction, which are not known that well,
/// at four fifths of the operations of Exp. Decay(0) is exactly 1; above 700 the result is that at 700, 1e-304.
template <class T>
constexpr T Decay(T x) {
  constexpr double kRounder = 6755399441055744.0;  // as in Exp
  const T y = Min(T(700.0), x);
  const T shifted = kRounder - y * 1.4426950408889634;  // -x / ln 2
  const T n = shifted - kRounder;
  const T r = -y - n * 0.6931471805599453;  // |r| <= ln(2) / 2, to 1e-13
  const T power =
      1.0 + r * Polynomial(r, 0.9999999999640528, 0.49999999999640693, 0.1666666699584014, 0.04166666699569589,
                           0.008333248647670299, 0.0013888804236757797, 0.0001992416907209688, 2.4884461638726358e-05);
  return power * FromBits((ToBits(shifted) + 1023) << 52);
}

/// Arc tangent [rad], in [-pi/2, pi/2]. Error below 2 ulp (1.93); exactly odd.
///
/// |x| is turned back by an angle b of 0, pi/4 or pi/2, of which (p, q) is the direction, so that the rest u
/// lies in [-t, t], t = tan(pi/8):  u = tan(atan|x| - b) = (p |x| - q) / (p + q |x|).
template <class T>
constexpr T Atan(T x) {
  const T a = Min(1e300, Abs(x));  // 0 * infinity would be NaN
  const T p = Select(a > 2.414213562373095, 0.0, 1.0);
  const T q = Select(a > 0.41421356237309503, 1.0, 0.0);
  const T eighths = 1.0 + q - p;  // b in units of pi/4

  const T u = (p * a - q) / (p + q * a);
  const T z = u * u;
  // atan u = u + u z r(z), 0 <= z <= t^2; error of r: 2e-18 of atan u.
  const T r = Polynomial(z, -0.333333333333332, 0.19999999999953247, -0.14285714280166595, 0.11111110782156568,
                         -0.0909089772529393, 0.07692059718144934, -0.06663099211571978, 0.058478593281613915,
                         -0.05039190665751603, 0.03806214583157053, -0.017905045851164026);
  // pi/4 as the nearest double and what that misses.
  const T turned = eighths * 0.7853981633974483;
  const T turned_rest = eighths * 3.061616997868383e-17;
  return CopySign(turned + (u + (u * z * r + turned_rest)), x);
}

namespace detail {

/// One step from y, near x^(-1/3), to a nearer one: with h = 1 - x y^3 the exact value is y (1 - h)^(-1/3),
/// here by its Taylor series up to h^3. An error |h| = 0.11 becomes 7e-5, and that 1e-17.
template <class T>
constexpr T RefineInverseCbrt(T x, T y) {
  const T h = 1.0 - (x * y) * (y * y);
  return y + y * (h * Polynomial(h, 1.0 / 3.0, 2.0 / 9.0, 14.0 / 81.0));
}

}  // namespace detail

/// x^(-1/3) without a division. Error below 1.25 ulp (1.14) for normal x > 0. The cube root is x
/// InverseCbrt(x)^2. For x = 0 and subnormal x the result is a finite number near 1e103 (the cube root so
/// formed is then 0 or below 1e-102, as in an open contact); for x < 0 and for infinity it is NaN.
template <class T>
constexpr T InverseCbrt(T x) {
  // The bit pattern of x is about 2^52 (1023 + log2 x), so that a third of it subtracted from a constant is
  // the pattern of a first guess. The third is the product (1/4 + 1/16) (1 + 1/16) (1 + 1/256) = 0.33333; the
  // constant makes the largest |h| of the first step smallest (0.1115, found by bisection over all
  // exponents).
  const BitsOf<T> bits = ToBits(x);
  const BitsOf<T> five_sixteenths = (bits >> 2) + (bits >> 4);
  const BitsOf<T> nearly_third = five_sixteenths + (five_sixteenths >> 4);
  const BitsOf<T> third = nearly_third + (nearly_third >> 8);
  const T guess = FromBits(0x553ecf9800000000 - third);
  const T y = detail::RefineInverseCbrt(x, detail::RefineInverseCbrt(x, guess));
  // In the first step an infinite x gives h = -infinity, whose polynomial is NaN.
  return Select(x >= 0.0, y, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace train_dynamics
