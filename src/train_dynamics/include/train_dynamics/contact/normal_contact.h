#pragma once

#include "train_dynamics/parameters.h"
#include "train_dynamics/spring/one_sided_spring.h"

namespace train_dynamics {

/// Stiffness and damping of a one-sided contact.
struct NormalContactParams {
  double stiffness_n_per_m = kRequired;
  double damping_ns_per_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("stiffness_n_per_m", stiffness_n_per_m, kPositive, "normal stiffness of one wheel on its rail");
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative, "normal damping of one wheel on its rail");
  }
};

}  // namespace train_dynamics
