#pragma once

#include <cstdint>

#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics::bench {

/// How often a law used each operation.
struct OperationCounts {
  long add = 0;  ///< and subtract
  long multiply = 0;
  long divide = 0;
  long square_root = 0;
  long compare = 0;
  long select = 0;  ///< and min, max, abs, copysign, changes of sign

  long Arithmetic() const { return add + multiply + divide + square_root; }
};

/// Operations on all Counted so far.
inline OperationCounts g_counts;

/// A number that counts what is done with it: a law that runs over Counted tells its own cost. Patterns of bits are not
/// counted.
class Counted {
 public:
  Counted() = default;
  Counted(double value) : value_(value) {}  // as a double converts to a pack
  explicit operator double() const { return value_; }
  double value() const { return value_; }

  friend Counted operator+(Counted a, Counted b) { return ++g_counts.add, a.value_ + b.value_; }
  friend Counted operator-(Counted a, Counted b) { return ++g_counts.add, a.value_ - b.value_; }
  friend Counted operator*(Counted a, Counted b) { return ++g_counts.multiply, a.value_ * b.value_; }
  friend Counted operator/(Counted a, Counted b) { return ++g_counts.divide, a.value_ / b.value_; }
  friend Counted operator-(Counted a) { return ++g_counts.select, -a.value_; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  Counted& operator/=(Counted b) { return *this = *this / b; }

  friend bool operator<(Counted a, Counted b) { return ++g_counts.compare, a.value_ < b.value_; }
  friend bool operator<=(Counted a, Counted b) { return ++g_counts.compare, a.value_ <= b.value_; }
  friend bool operator>(Counted a, Counted b) { return ++g_counts.compare, a.value_ > b.value_; }
  friend bool operator>=(Counted a, Counted b) { return ++g_counts.compare, a.value_ >= b.value_; }
  friend bool operator==(Counted a, Counted b) { return ++g_counts.compare, a.value_ == b.value_; }
  friend bool operator!=(Counted a, Counted b) { return ++g_counts.compare, a.value_ != b.value_; }

  friend Counted Select(bool mask, Counted a, Counted b) { return ++g_counts.select, mask ? a : b; }
  friend Counted Max(Counted a, Counted b) { return ++g_counts.select, a.value_ > b.value_ ? a : b; }
  friend Counted Min(Counted a, Counted b) { return ++g_counts.select, a.value_ < b.value_ ? a : b; }
  friend Counted Clamp(Counted x, Counted low, Counted high) { return Min(high, Max(low, x)); }
  friend Counted Abs(Counted x) { return ++g_counts.select, Abs(x.value_); }
  friend Counted CopySign(Counted magnitude, Counted sign) {
    return ++g_counts.select, CopySign(magnitude.value_, sign.value_);
  }
  friend Counted Sqrt(Counted x) { return ++g_counts.square_root, Sqrt(x.value_); }
  friend std::uint64_t ToBits(Counted x) { return ToBits(x.value_); }
  template <class Function>
  friend Counted MapLanes(const Function& function, Counted x) {
    return function(x.value_);
  }

 private:
  double value_ = 0.0;
};

}  // namespace train_dynamics::bench

namespace train_dynamics {

template <>
struct ScalarTypes<bench::Counted> {
  using Mask = bool;
  using Bits = std::uint64_t;
  static constexpr int kLanes = 1;
};

}  // namespace train_dynamics
