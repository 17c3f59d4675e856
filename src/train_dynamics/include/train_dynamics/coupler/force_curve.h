#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "train_dynamics/coupler/hysteresis.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A force over a travel, linear between points; the first point is (0, 0).
struct ForceCurveParams {
  static constexpr std::size_t kMostPoints = 32;

  std::vector<double> travel_m;
  std::vector<double> force_n;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("travel_m", travel_m, kNonNegative,
              "travels of the curve from the end of the slack on: 0 first, ascending, 2 to 32 points");
    v.Numbers("force_n", force_n, kNonNegative, "force at each of them: 0 first, not descending");
    v.Check(travel_m.size() >= 2 && travel_m.size() <= kMostPoints, "travel_m", "must list 2 to 32 points");
    v.Check(travel_m.empty() || travel_m.front() == 0.0, "travel_m", "must start at 0, the end of the slack");
    v.Check(std::adjacent_find(travel_m.begin(), travel_m.end(), std::greater_equal<>()) == travel_m.end(), "travel_m",
            "must ascend");
    v.Check(force_n.size() == travel_m.size(), "force_n", "must have as many values as travel_m", {"travel_m"});
    v.Check(force_n.empty() || force_n.front() == 0.0, "force_n",
            "must start at 0: at the end of the slack there is no force");
    v.Check(std::is_sorted(force_n.begin(), force_n.end()), "force_n", "must not descend");
  }

  /// The force at a travel [m]; beyond the last point that of the last point.
  double At(double at_m) const;
  double SteepestSlope() const;  ///< [N/m]
};

/// Loading and unloading of a device in one direction, without slack and solid stop.
struct HysteresisParams {
  ForceCurveParams loading, unloading;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Group("loading", loading, "force over travel while it is loaded");
    v.Group("unloading", unloading, "force over travel while it is unloaded, nowhere above loading");
    v.Check(
        loading.travel_m.empty() || unloading.travel_m.empty() || loading.travel_m.back() == unloading.travel_m.back(),
        "unloading.travel_m", "must end where loading.travel_m ends", {"loading", "unloading"});
    v.Check(!UnloadsAboveLoading(), "unloading.force_n",
            "must nowhere be above loading.force_n: where the curves cross the device would give energy",
            {"loading", "unloading"});
  }

  double SteepestSlope() const { return std::max(loading.SteepestSlope(), unloading.SteepestSlope()); }

 private:
  bool UnloadsAboveLoading() const;
};

/// A force curve as its segments.
struct ForceCurve {
  explicit ForceCurve(const ForceCurveParams& params);

  template <class T>
  T Force(T travel) const {
    T force(0.0);
    for (int i = 0; i < segments; ++i) {
      force = force + slope_n_per_m[i] * Clamp(travel - begin_m[i], T(0.0), T(length_m[i]));
    }
    return force;
  }
  template <class T>
  T Energy(T travel) const {
    T energy = begin_n[segments] * Max(T(0.0), travel - begin_m[segments]);
    for (int i = 0; i < segments; ++i) {
      const T along = Clamp(travel - begin_m[i], T(0.0), T(length_m[i]));
      energy = energy + along * (begin_n[i] + 0.5 * slope_n_per_m[i] * along);
    }
    return energy;
  }
  /// See EndOfStick in coupler/hysteresis.h. Along the curve h = F - k x falls from 0; the end is where it has fallen
  /// to force - k travel.
  template <class T>
  T EndOfStick(T travel, T force, double stiffness_n_per_m) const {
    const T goal = force - stiffness_n_per_m * travel;
    T end(0.0);
    for (int i = 0; i < segments; ++i) {
      const double h = begin_n[i] - stiffness_n_per_m * begin_m[i];
      const double steeper = stiffness_n_per_m - slope_n_per_m[i];
      end = end + Clamp((h - goal) * (1.0 / steeper), T(0.0), T(length_m[i]));
    }
    const double h = begin_n[segments] - stiffness_n_per_m * begin_m[segments];
    return end + Max(T(0.0), (h - goal) * (1.0 / stiffness_n_per_m));
  }

  int segments;
  /// Of each segment; the one past the last begins at the end.
  double begin_m[ForceCurveParams::kMostPoints], begin_n[ForceCurveParams::kMostPoints];
  double length_m[ForceCurveParams::kMostPoints], slope_n_per_m[ForceCurveParams::kMostPoints];
};

/// A device given by tables, as coupler/hysteresis.h wants it. Beyond the last points the branches stay level and the
/// solid stop is added.
struct TableDevice {
  TableDevice(const HysteresisParams& tables, double stiffness_n_per_m, double damping_ns_per_m, double solid_n_per_m)
      : loading(tables.loading),
        unloading(tables.unloading),
        solid_stiffness_n_per_m(solid_n_per_m),
        stick_stiffness_n_per_m(stiffness_n_per_m),
        stick_damping_ns_per_m(damping_ns_per_m) {}

  template <class T>
  T Loading(T travel) const {
    return loading.Force(travel);
  }
  template <class T>
  T Unloading(T travel) const {
    return unloading.Force(travel);
  }
  template <class T>
  T UnloadingEnergy(T travel) const {
    return unloading.Energy(travel);
  }
  template <class T>
  T EndOfStick(T travel, T force) const {
    return Min(travel, unloading.EndOfStick(travel, force, stick_stiffness_n_per_m));
  }
  template <class T>
  T Stop(T travel) const {
    return solid_stiffness_n_per_m * Max(T(0.0), travel - loading.begin_m[loading.segments]);
  }
  template <class T>
  T StopEnergy(T travel) const {
    const T beyond = Max(T(0.0), travel - loading.begin_m[loading.segments]);
    return 0.5 * solid_stiffness_n_per_m * beyond * beyond;
  }

  ForceCurve loading, unloading;
  double solid_stiffness_n_per_m;
  double stick_stiffness_n_per_m, stick_damping_ns_per_m;
};

}  // namespace train_dynamics
