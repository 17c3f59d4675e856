#pragma once

#include <array>

#include "train_dynamics/track/track.h"

namespace train_dynamics {

inline AdhesionParams Surface(double mu0, double a, double b, double ka, double ks) {
  AdhesionParams surface;
  surface.friction_coefficient = mu0;
  surface.friction_ratio = a;
  surface.friction_decay_s_per_m = b;
  surface.adhesion_reduction = ka;
  surface.slip_reduction = ks;
  return surface;
}

inline const AdhesionParams kOwn = Surface(0.4, 0.8, 0.1, 0.9, 0.5);
inline const AdhesionParams kLeaves = Surface(0.05, 0.4, 0.2, 0.3, 0.1);

inline std::array<double, 5> AdhesionNumbers(const AdhesionParams& p) {
  return {p.friction_coefficient, p.friction_ratio, p.friction_decay_s_per_m, p.adhesion_reduction, p.slip_reduction};
}

inline FrictionPatchParams Leaves(double from_m, double to_m, double ramp_m) {
  FrictionPatchParams patch;
  patch.from_m = from_m;
  patch.to_m = to_m;
  patch.adhesion = kLeaves;
  patch.ramp_length_m = ramp_m;
  return patch;
}

}  // namespace train_dynamics
