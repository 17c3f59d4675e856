#pragma once

#include <string>
#include <vector>

namespace train_brake_rviz {

/// The smallest of 1, 2 and 5 times a power of ten that is not below a value > 0.
double NiceCeiling(double value);

/// Maps values to a line on the board.
struct Axis {
  double min, max;  ///< values at its ends, min < max
  double from, to;  ///< places of the ends on the board

  double operator()(double value) const { return from + (to - from) * (value - min) / (max - min); }
  /// The same, but no further than the ends.
  double Clamped(double value) const;
  /// Round values from end to end, about `count` of them.
  std::vector<double> Ticks(int count) const;
};

/// A number with so many decimals, never "-0"; a dash for what is not finite.
std::string Rounded(double value, int decimals);

/// A tick's number with as many decimals as its distance from the next one asks for.
std::string TickText(double value, double distance);

/// An end of a scale that is a round number and follows the values upwards only, so that a picture does not
/// jump.
class GrowingLimit {
 public:
  /// @param least  where it begins, > 0
  explicit GrowingLimit(double least) : limit_(NiceCeiling(least)) {}
  /// @param size  >= 0; what is not finite is ignored
  void Include(double size);
  double value() const { return limit_; }

 private:
  double limit_;
};

}  // namespace train_brake_rviz
