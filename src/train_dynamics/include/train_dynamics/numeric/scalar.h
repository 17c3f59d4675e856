#pragma once

#include <cfloat>
#include <cmath>
#include <cstdint>

/// Before a function that calls laws: all of these become part of it. (Not in a build with sanitizers, whose checks in
/// such a function keep the compiler busy for a quarter of an hour.)
#ifdef TRAIN_BRAKE_SANITIZED
#define TRAIN_DYNAMICS_FLATTEN
#else
#define TRAIN_DYNAMICS_FLATTEN [[gnu::flatten]]
#endif

/// The words in which a law is written once, for one number or for several side by side.
///
/// A law is a template over a scalar type T: `double`, or a pack of doubles (numeric/lanes.h). It may use
/// + - * /, comparisons (which yield a MaskOf<T>), double constants, and the functions below; it must not
/// branch on a T. Masks are combined with & | and !, never with && or ||, because every lane is computed.
/// (A condition on a parameter, the same in every lane, is an ordinary `if`.)
/// @code
///     template <class T>
///     T Stop(T gap_m, double stiffness_n_per_m) {
///       return Select(gap_m < 0.0, -stiffness_n_per_m * gap_m, 0.0);
///     }
/// @endcode
/// Every function returns in each lane the bits that the double version returns. That holds for NaN too
/// (except for its sign and payload, which no rule of the language fixes).
namespace train_dynamics {

static_assert(FLT_EVAL_METHOD == 0, "double must be computed as double: x87 would give other bits than lanes do");

/// The types that belong to T.
template <class T>
struct ScalarTypes;

template <>
struct ScalarTypes<double> {
  using Mask = bool;
  using Bits = std::uint64_t;
  static constexpr int kLanes = 1;
};

/// What a comparison of two T yields.
template <class T>
using MaskOf = typename ScalarTypes<T>::Mask;

/// The 64-bit pattern of T: has + and - modulo 2^64, << and >> by a count, where zeros enter.
template <class T>
using BitsOf = typename ScalarTypes<T>::Bits;

/// How many numbers a T holds.
template <class T>
inline constexpr int kLanesOf = ScalarTypes<T>::kLanes;

/// As many consecutive numbers as a T holds, from and to memory.
template <class T>
T Load(const double* from) {
  if constexpr (kLanesOf<T> == 1) {
    return *from;
  } else {
    return T::Load(from);
  }
}
template <class T>
void Store(const T& x, double* to) {
  if constexpr (kLanesOf<T> == 1) {
    *to = static_cast<double>(x);
  } else {
    x.Store(to);
  }
}

/// `a` where the mask holds, else `b`. Both are evaluated, and the one not chosen may be NaN or infinite.
/// (For a single double a compiler may make a branch of it and skip the other's arithmetic; the bits are the
/// same.)
constexpr double Select(bool mask, double a, double b) { return mask ? a : b; }

/// a > b ? a : b. A NaN, or a zero that differs only in sign, yields `b`: so Max(limit, x) keeps the NaN
/// of x and Max(x, limit) loses it. Write the limit first.
constexpr double Max(double a, double b) { return a > b ? a : b; }

/// a < b ? a : b. As in Max, a NaN yields `b`: write the limit first.
constexpr double Min(double a, double b) { return a < b ? a : b; }

/// x limited to [low, high], low <= high. A NaN in x stays.
constexpr double Clamp(double x, double low, double high) { return Min(high, Max(low, x)); }

/// |x|; clears the sign bit.
constexpr double Abs(double x) { return __builtin_fabs(x); }

/// The square root, correctly rounded; NaN for x < 0. (With -fno-math-errno it is one instruction.)
inline double Sqrt(double x) { return std::sqrt(x); }

/// The magnitude of one number with the sign bit of another (that of -0.0 and of a NaN count too).
constexpr double CopySign(double magnitude, double sign) { return __builtin_copysign(magnitude, sign); }

constexpr bool AnyOf(bool mask) { return mask; }
constexpr bool AllOf(bool mask) { return mask; }

/// The IEEE 754 binary64 pattern of x: sign, 11 bits of exponent, 52 bits of fraction.
constexpr std::uint64_t ToBits(double x) { return __builtin_bit_cast(std::uint64_t, x); }

/// The number with this pattern.
constexpr double FromBits(std::uint64_t bits) { return __builtin_bit_cast(double, bits); }

/// A function of one number applied to each number in T: for what is looked up rather than computed.
template <class Function>
double MapLanes(const Function& function, double x) {
  return function(x);
}

}  // namespace train_dynamics
