#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A bilateral linear spring and damper in parallel: F = k d + c d' [N].
///
/// The rubber pads of the axle-box adaptors, the longitudinal guidance of bolsters and centre plates.
/// The damper only dissipates: c d'^2 >= 0.
struct LinearSpringDamper {
  double stiffness_n_per_m = kRequired;
  double damping_ns_per_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("stiffness_n_per_m", stiffness_n_per_m, kPositive, "k in F = k d + c d'");
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative, "c in F = k d + c d'");
  }
};

}  // namespace train_dynamics
