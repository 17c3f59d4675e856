#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A stretch of constant grade: holds from `from_m` to the next entry's; the first also holds before it.
struct GradeParams {
  double from_m = kRequired;
  double grade_percent = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite,
             "position from which the grade holds, up to the next entry's; the first also holds before it");
    v.Number("grade_percent", grade_percent, Range{-20.0, 20.0, false, false},
             "rise over run, uphill positive as positions rise");
  }
};

}  // namespace train_dynamics
