#pragma once

#include <vector>

#include "train_dynamics/track/pieces.h"

namespace train_dynamics {

/// A value that holds from a position on.
struct StepValue {
  double from_m, value;
};

/// A quantity that is constant between given positions along the track.
///
/// Each value holds from its position to the next one's; the first also holds before it, the last to all that lies
/// behind. A look-up costs the same for any number of steps (track/pieces.h).
class StepFunction {
 public:
  explicit StepFunction(double value = 0.0) : values_{value} {}
  /// @param steps           by rising position
  /// @param without_steps   the value everywhere if there are none
  StepFunction(const std::vector<StepValue>& steps, double without_steps);

  /// Whether it has one value everywhere, `First`.
  bool IsConstant() const { return values_.size() == 1; }
  double First() const { return values_.front(); }

  /// A value and where it holds.
  struct Held {
    Stretch on;
    double value;
  };
  Held From(double position_m) const;
  double At(double position_m) const;
  void At(int count, const double* position_m, double* value) const;
  /// The smallest value between two positions, both included; takes the time of the steps between them.
  double SmallestOn(double from_m, double to_m) const;

 private:
  Pieces pieces_;
  std::vector<double> values_;  ///< [piece]
};

}  // namespace train_dynamics
