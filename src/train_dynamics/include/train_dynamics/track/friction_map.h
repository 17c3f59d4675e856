#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A patch of rail with a friction coefficient of its own, in place of the vehicles' mu0.
struct FrictionPatchParams {
  double from_m = kRequired;
  double to_m = kRequired;
  double friction_coefficient = kRequired;  ///< mu0 on [from_m, to_m)

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite);
    v.Number("to_m", to_m, kFinite);
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false});
    v.Check(from_m < to_m, "to_m", "must be greater than from_m");
  }
};

}  // namespace train_dynamics
