#pragma once

#include <algorithm>
#include <functional>

#include "paper_vehicle.h"
#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {

inline constexpr double kMass = 5.0e6;  // [kg] of a train as one vehicle

/// A locomotive that reaches its effort at once.
inline TractionParams QuickLocomotive(double starting_effort_n, double rim_power_w) {
  TractionParams p;
  p.tractive_effort.starting_effort_n = starting_effort_n;
  p.tractive_effort.rim_power_w = rim_power_w;
  p.tractive_effort.usable_adhesion.law = UsableAdhesionLaw::kUnlimited;
  p.drive = {1e12, 1e12, 0.0};
  return p;
}

/// A whole train as one LTD vehicle of 5000 t, with the paper's resistance or none; no rotating mass.
inline LtdVehicle Train(bool with_resistance) {
  VehicleParams p = OreWagon();
  p.carbody.mass_kg += kMass - p.TotalMass();
  if (!with_resistance) p.propulsion_resistance = {0.0, 0.0, 0.0};
  return {p, false};
}

/// Drives until `done(time, state)`. @return the time
inline double Drive(const LtdVehicle& train, const TractionParams& p, int locomotives, const NotchCommand& command,
                    double grade_percent, double dt, const std::function<bool(double, const LtdState<double>&)>& done,
                    LtdState<double>& s, DriveState& drive) {
  TrackParams slope;
  slope.grades = {{0.0, grade_percent}};
  const Track track(slope);
  double t = 0.0;
  for (; !done(t, s); t += dt) {
    StepDrive(p.drive, WantedEffort(p, command, s.v_mps, 1e12), dt, drive);
    VehicleLoads<double> loads;
    loads.traction_n = locomotives * std::max(drive.effort_n, 0.0);
    loads.dynamic_brake_n = locomotives * std::max(-drive.effort_n, 0.0);
    StepLtd(train, track, loads, dt, s);
  }
  return t;
}

}  // namespace train_dynamics
