#pragma once

#include "train_dynamics/parameters.h"
#include "train_dynamics/spring/one_sided_spring.h"

namespace train_dynamics {

/// Centre plate between carbody and bolster: two one-sided rim points, each with half of the vertical
/// stiffness and damping, and a bilateral longitudinal spring and damper of the same values. The plate may
/// lift off and rock.
struct CentrePlateParams {
  double stiffness_n_per_m = kRequired;
  double damping_ns_per_m = kRequired;
  double rim_offset_m = kRequired;
  double height_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("stiffness_n_per_m", stiffness_n_per_m, kPositive,
             "of the whole plate, vertical; the same longitudinally");
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative,
             "of the whole plate, vertical; the same longitudinally");
    v.Number("rim_offset_m", rim_offset_m, kPositive, "distance of the two rim points before and behind the centre");
    v.Number("height_m", height_m, kFinite, "height above rail at which the longitudinal force acts");
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
