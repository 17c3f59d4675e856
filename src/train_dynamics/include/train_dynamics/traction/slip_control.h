#pragma once

#include <cmath>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Takes torque from driven wheelsets that slip (2D model).
struct SlipControlParams {
  double sampling_period_s = 0.005;
  double target_creepage = 0.02;
  double least_slip_mps = 0.1;
  double gain_per_mps = 0.3;
  double recovery_per_s = 0.2;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("sampling_period_s", sampling_period_s, Range{0.0, 0.005, true, false},
             "T_s, a multiple of dt_s; a wheelset over its limit runs away in 25 ms");
    v.Number("target_creepage", target_creepage, Range{0.0, 1.0, true, true},
             "slip speed s* over the train's speed that the control aims at");
    v.Number("least_slip_mps", least_slip_mps, kPositive, "least value of s* [A]");
    v.Number("gain_per_mps", gain_per_mps, kPositive, "share of the torque that is taken per slip speed beyond s* [A]");
    v.Number("recovery_per_s", recovery_per_s, kPositive, "share of the torque that comes back per second [A]");
  }
};

/// Share by which the torque of a wheelset is reduced from now on [-], 0 ... 1:
///
///   reduction = max( K (s - s*),  reduction before - recovery T_s ),   s = u - v,  s* = max(0.02 v, 0.1 m/s)
///
/// s > s* takes torque at once; it comes back slowly.
///
/// @param reduction        of the sample before
/// @param speed_mps        v, of the vehicle: the ideal reference
/// @param wheel_speed_mps  u, of the tread
inline double NextReduction(const SlipControlParams& p, double reduction, double speed_mps, double wheel_speed_mps) {
  // Traction pulls forwards: treads that are faster than the vehicle slip, whether it rolls forwards or backwards.
  const double slip_mps = wheel_speed_mps - speed_mps;
  const double target_mps = Max(p.least_slip_mps, p.target_creepage * std::abs(speed_mps));
  const double asked = Clamp(p.gain_per_mps * (slip_mps - target_mps), 0.0, 1.0);
  return Max(asked, Max(0.0, reduction - p.recovery_per_s * p.sampling_period_s));
}

}  // namespace train_dynamics
