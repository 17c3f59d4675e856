#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Adhesion of a rail surface in Polach's model; see contact/polach.h for the law.
struct AdhesionParams {
  double friction_coefficient = kRequired;
  double friction_ratio = 1.0;
  double friction_decay_s_per_m = 0.0;
  double adhesion_reduction = 1.0;
  double slip_reduction = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false},
             "mu0, coefficient of friction between wheel and rail at zero slip speed");
    v.Number("friction_ratio", friction_ratio, Range{0.0, 1.0, true, false},
             "A, friction at infinite slip speed over mu0");
    v.Number("friction_decay_s_per_m", friction_decay_s_per_m, kNonNegative,
             "B, how fast friction falls as the slip speed w rises: mu = mu0 ((1 - A) exp(-B w) + A)");
    v.Number("adhesion_reduction", adhesion_reduction, Range{0.0, 1.0, true, false},
             "kA, factor on the contact's stiffness in its area of adhesion: 1 clean rail, less with a layer "
             "on it");
    v.Number("slip_reduction", slip_reduction, Range{0.0, 1.0, true, false}, "kS, the same factor in the area of slip");
    v.Check(slip_reduction <= adhesion_reduction, "slip_reduction", "must be at most adhesion_reduction");
  }
};

}  // namespace train_dynamics
