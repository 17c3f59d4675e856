#include "train_dynamics/traction/locomotive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
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

TEST(Traction, AcceleratesAsTheClosedFormSays) {
  // M v1 / F + M (v2^2 - v1^2) / 2P and M v1^2 / 2F + M (v2^3 - v1^3) / 3P, corner v1 = P / F = 3.75 m/s.
  const double f = 800e3, power = 3.0e6, v1 = power / f, v2 = 20.0;
  const double time_s = kMass * v1 / f + kMass * (v2 * v2 - v1 * v1) / (2.0 * power);
  const double way_m =
      kMass * v1 * v1 / (2.0 * f) + kMass * (std::pow(v2, 3) - std::pow(v1, 3)) / (3.0 * power);
  EXPECT_NEAR(time_s, 345.052, 5e-4);
  EXPECT_NEAR(way_m, 4459.093, 5e-4);
  constexpr double kDt = 1e-3;
  LtdState<double> s;
  DriveState drive;
  const double t = Drive(
      Train(false), QuickLocomotive(f, power), 1, {8, 0}, 0.0, kDt,
      [v2](double, const auto& state) { return state.v_mps >= v2; }, s, drive);
  // Forces are held from the step's start: at most half a step late, and a whole one to notice the end.
  EXPECT_NEAR(t, time_s, 1.5 * kDt);
  EXPECT_NEAR(s.x_m, way_m, 1.5 * kDt * v2);
  EXPECT_NEAR(s.work.traction, 0.5 * kMass * s.v_mps * s.v_mps, 1e-9 * kMass * v2 * v2);
}

TEST(Traction, BalancesGradeAndResistance) {
  const LtdVehicle train = Train(true);
  const TractionParams p = QuickLocomotive(800e3, 3.0e6);
  const auto after = [](double end_s) { return [end_s](double t, const auto&) { return t >= end_s; }; };
  LtdState<double> s;
  DriveState drive;
  // The approach is exponential with M v / (F + ...) of some 100 s.
  Drive(train, p, 2, {8, 0}, 1.0, 0.01, after(3000.0), s, drive);
  EXPECT_NEAR(s.v_mps, 10.8280, 5e-5);
  EXPECT_NEAR(2.0 * drive.effort_n, 554.120e3, 1.0);
  s = {};
  Drive(train, p, 2, {8, 0}, 0.0, 0.01, after(20000.0), s, drive);
  EXPECT_NEAR(3.6 * s.v_mps, 125.776, 5e-4);
}

}  // namespace
}  // namespace train_dynamics
