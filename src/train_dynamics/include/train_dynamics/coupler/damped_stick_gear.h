#pragma once

#include "train_dynamics/coupler/draft_gear.h"
#include "train_dynamics/coupler/hysteresis.h"

namespace train_dynamics {

/// One friction draft gear as a device with hysteresis (coupler/hysteresis.h):
///
///   Loading = F_s t / (t - mu),  Unloading = F_s t / (t + mu),  t = tan(phi)
///
/// F_s of GearSpringForce; mu does not depend on speed.
struct FrictionDevice {
  explicit FrictionDevice(const DraftGearParams& gear)
      : params(gear),
        loading(gear.TanWedge() / (gear.TanWedge() - gear.kinetic_friction_coefficient)),
        unloading(gear.TanWedge() / (gear.TanWedge() + gear.kinetic_friction_coefficient)),
        stick_stiffness_n_per_m(gear.gear_stick_stiffness_n_per_m),
        stick_damping_ns_per_m(gear.gear_stick_damping_ns_per_m) {}

  template <class T>
  T Loading(T travel) const {
    return loading * GearSpringForce(params, travel);
  }
  template <class T>
  T Unloading(T travel) const {
    return unloading * GearSpringForce(params, travel);
  }
  template <class T>
  T UnloadingEnergy(T travel) const {
    return unloading * GearSpringEnergy(params, travel);
  }
  /// By Newton's method; the branch is so much less steep than the stick line that four steps meet it to rounding.
  template <class T>
  T EndOfStick(T travel, T force) const {
    T end = travel;
    for (int i = 0; i < 5; ++i) {
      const T gap = force - stick_stiffness_n_per_m * (travel - end) - Unloading(end);
      end = end - gap / (stick_stiffness_n_per_m - unloading * GearSpringSlope(params, end));
      end = Clamp(end, T(0.0), travel);
    }
    return end;
  }
  template <class T>
  T Stop(T travel) const {
    return GearStopForce(params, travel);
  }
  template <class T>
  T StopEnergy(T travel) const {
    const T beyond = Max(T(0.0), travel - params.travel_m);
    return 0.5 * params.solid_stiffness_n_per_m * beyond * beyond;
  }

  DraftGearParams params;
  double loading, unloading;  ///< factors
  double stick_stiffness_n_per_m, stick_damping_ns_per_m;
};

/// Two equal friction draft gears in series: the default for real trains.
struct DampedStickGears : HystereticConnection<FrictionDevice> {
  explicit DampedStickGears(const DraftGearParams& gear)
      : HystereticConnection<FrictionDevice>{gear.slack_m, 0.5, 0.0, FrictionDevice(gear), FrictionDevice(gear), true} {
  }
};

}  // namespace train_dynamics
