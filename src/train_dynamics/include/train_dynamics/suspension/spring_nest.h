#pragma once

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Half a nest of coil springs under one end of a bolster (a quarter of a bogie).
struct SpringNestParams {
  double outer_stiffness_n_per_m = kRequired;
  double inner_stiffness_n_per_m = kRequired;
  double stage1_travel_m = kRequired;
  double stage2_travel_m = kRequired;
  double solid_stiffness_n_per_m = kRequired;
  double rebound_clearance_m = kRequired;
  double offset_m = kRequired;
  double damping_ns_per_m = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("outer_stiffness_n_per_m", outer_stiffness_n_per_m, kPositive,
             "stiffness of the outer springs of the half nest");
    v.Number("inner_stiffness_n_per_m", inner_stiffness_n_per_m, kNonNegative,
             "stiffness of its inner springs, in addition from stage1_travel_m on");
    v.Number("stage1_travel_m", stage1_travel_m, kNonNegative, "compression at which the inner springs take load");
    v.Number("stage2_travel_m", stage2_travel_m, kNonNegative, "further compression until the coils are solid");
    v.Number("solid_stiffness_n_per_m", solid_stiffness_n_per_m, kPositive, "stiffness of the solid coils");
    v.Number("rebound_clearance_m", rebound_clearance_m, kNonNegative,
             "extension at which the bolster meets the rebound stop");
    v.Number("offset_m", offset_m, kNonNegative, "distance of the half nest before and behind the bolster's centre");
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative, "of a linear damper beside the half nest");
  }
};

/// Force of half a nest [N], positive = pressing bolster and frame apart.
///
///   F = k_o d+ + k_i (d - s1)+ + k_s (d - s1 - s2)+ - k_s (-d - c)+,   (.)+ = max(., 0)
///
/// @param d  compression [m]; negative = extension: no force up to the clearance c, then the rebound stop
template <class T>
T SpringNestForce(const SpringNestParams& p, T d) {
  const T zero(0.0);
  return p.outer_stiffness_n_per_m * Max(zero, d) + p.inner_stiffness_n_per_m * Max(zero, d - p.stage1_travel_m) +
         p.solid_stiffness_n_per_m *
             (Max(zero, d - (p.stage1_travel_m + p.stage2_travel_m)) - Max(zero, -d - p.rebound_clearance_m));
}

/// Elastic energy of half a nest [J]: the integral of SpringNestForce from d = 0.
template <class T>
T SpringNestEnergy(const SpringNestParams& p, T d) {
  const auto half_square = [](T x) {
    const T closed = Max(T(0.0), x);
    return 0.5 * closed * closed;
  };
  return p.outer_stiffness_n_per_m * half_square(d) + p.inner_stiffness_n_per_m * half_square(d - p.stage1_travel_m) +
         p.solid_stiffness_n_per_m *
             (half_square(d - (p.stage1_travel_m + p.stage2_travel_m)) + half_square(-d - p.rebound_clearance_m));
}

}  // namespace train_dynamics
