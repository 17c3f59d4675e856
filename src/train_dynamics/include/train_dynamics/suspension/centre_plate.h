#pragma once

#include "train_dynamics/parameters.h"
#include "train_dynamics/spring/one_sided_spring.h"

namespace train_dynamics {

/// Centre plate between carbody and bolster: two one-sided rim points, each with half of the vertical
/// stiffness and damping, and a bilateral longitudinal spring and damper of the same values. The plate may
/// lift off and rock.
struct CentrePlateParams {
  double stiffness_n_per_m = kRequired;  ///< of the whole plate, vertical; also longitudinal
  double damping_ns_per_m = kRequired;   ///< of the whole plate, vertical; also longitudinal
  double rim_offset_m = kRequired;       ///< of the rim points before and behind the centre
  double height_m = kRequired;           ///< above rail, where the longitudinal force acts

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("stiffness_n_per_m", stiffness_n_per_m, kPositive);
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative);
    v.Number("rim_offset_m", rim_offset_m, kPositive);
    v.Number("height_m", height_m, kFinite);
  }
};

/// Vertical force of one rim point [N], >= 0, up on the carbody and down on the bolster.
template <class T>
T RimForce(const CentrePlateParams& p, T penetration, T rate) {
  return OneSidedForce(0.5 * p.stiffness_n_per_m, 0.5 * p.damping_ns_per_m, penetration, rate);
}

/// Elastic energy of one rim point [J].
template <class T>
T RimEnergy(const CentrePlateParams& p, T penetration) {
  return OneSidedEnergy(0.5 * p.stiffness_n_per_m, penetration);
}

}  // namespace train_dynamics
