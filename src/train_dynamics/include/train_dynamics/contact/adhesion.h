#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Adhesion of a rail surface in Polach's model; see contact/polach.h for the law.
struct AdhesionParams {
  double friction_coefficient = kRequired;  ///< mu0, at zero slip speed
  double friction_ratio = 1.0;              ///< A = mu(infinite slip) / mu0
  double friction_decay_s_per_m = 0.0;      ///< B
  double adhesion_reduction = 1.0;          ///< kA, in the area of adhesion
  double slip_reduction = 1.0;              ///< kS, in the area of slip

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false});
    v.Number("friction_ratio", friction_ratio, Range{0.0, 1.0, true, false});
    v.Number("friction_decay_s_per_m", friction_decay_s_per_m, kNonNegative);
    v.Number("adhesion_reduction", adhesion_reduction, Range{0.0, 1.0, true, false});
    v.Number("slip_reduction", slip_reduction, Range{0.0, 1.0, true, false});
    v.Check(slip_reduction <= adhesion_reduction, "slip_reduction", "must be at most adhesion_reduction");
  }
};

}  // namespace train_dynamics
