#include "train_dynamics/traction/dynamic_brake.h"

#include <gtest/gtest.h>

#include <functional>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

constexpr double kMass = 5.0e6;  // [kg] of a train as one vehicle

/// A locomotive that reaches its effort at once.
TractionParams QuickLocomotive(double starting_effort_n, double rim_power_w) {
  TractionParams p;
  p.tractive_effort.starting_effort_n = starting_effort_n;
  p.tractive_effort.rim_power_w = rim_power_w;
  p.tractive_effort.usable_adhesion.law = UsableAdhesionLaw::kUnlimited;
  p.drive = {1e12, 1e12, 0.0};
  return p;
}

/// A whole train as one LTD vehicle of 5000 t, with the paper's resistance or none; no rotating mass.
LtdVehicle Train(bool with_resistance) {
  VehicleParams p = OreWagon();
  p.carbody.mass_kg += kMass - p.TotalMass();
  if (!with_resistance) p.propulsion_resistance = {0.0, 0.0, 0.0};
  return {p, false};
}

/// Drives until `done(time, state)`. @return the time
double Drive(const LtdVehicle& train, const TractionParams& p, int locomotives, const NotchCommand& command,
             double grade_percent, double dt,
             const std::function<bool(double, const LtdState<double>&)>& done, LtdState<double>& s,
             DriveState& drive) {
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

TEST(DynamicBrake, FadesAtLowSpeedAndIsLimitedByPower) {
  DynamicBrakeParams p;
  p.largest_effort_n = 300e3;
  p.rim_power_w = 3.0e6;
  p.fade_speed_mps = 5.0;
  EXPECT_EQ(DynamicBrakeEffort(p, 8, 0.0), 0.0);
  EXPECT_NEAR(DynamicBrakeEffort(p, 8, 2.5), 150e3, 1e-9);
  EXPECT_NEAR(DynamicBrakeEffort(p, 8, -2.5), 150e3, 1e-9);
  EXPECT_NEAR(DynamicBrakeEffort(p, 8, 8.0), 300e3, 1e-9);
  EXPECT_NEAR(DynamicBrakeEffort(p, 8, 20.0), 150e3, 1e-9);
  EXPECT_NEAR(DynamicBrakeEffort(p, 2, 20.0), 0.25 * 150e3, 1e-9);
}

TEST(DynamicBrake, HoldsATrainOnAGrade) {
  TractionParams p = QuickLocomotive(800e3, 3.0e6);
  p.dynamic_brake = DynamicBrakeParams();
  p.dynamic_brake->largest_effort_n = 0.5 * 426.146e3;
  p.dynamic_brake->rim_power_w = 5e6;
  LtdState<double> s;
  s.v_mps = 40.0 / 3.6;
  DriveState drive;
  Drive(
      Train(true), p, 2, {0, 8}, -1.0, 0.01, [](double t, const auto&) { return t >= 600.0; }, s, drive);
  // Half a newton over 600 s moves 5000 t by 6e-5 m/s.
  EXPECT_NEAR(s.v_mps, 40.0 / 3.6, 1e-4);
  EXPECT_NEAR(s.work.dissipated[kDynamicBrake], 426.146e3 * s.x_m, 1e-6 * 426.146e3 * s.x_m);
}

}  // namespace
}  // namespace train_dynamics
