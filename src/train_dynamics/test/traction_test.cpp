#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

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

TEST(UsableAdhesion, CurtiusKnifflerByHand) {
  // 0.161 + 7.5 / (k + 44); half a unit of the last printed digit
  EXPECT_NEAR(CurtiusKniffler(0.0), 0.33145, 5e-6);
  EXPECT_NEAR(CurtiusKniffler(40.0 / 3.6), 0.25029, 5e-6);
  EXPECT_NEAR(CurtiusKniffler(-80.0 / 3.6), 0.22148, 5e-6);
  UsableAdhesionParams p;
  p.factor = 1.2;
  EXPECT_NEAR(UsableAdhesion(p, 0.0), 1.2 * 0.3314545, 1e-6);
  p.law = UsableAdhesionLaw::kConstant;
  EXPECT_NEAR(UsableAdhesion(p, 30.0), 1.2 * 0.36, 1e-15);
}

TEST(NotchShare, IsThatOfWholeNotchesAndLinearBetweenThem) {
  const std::vector<double> shares = {0.1, 0.4, 1.0};
  EXPECT_EQ(NotchShare(shares, 0.0), 0.0);
  EXPECT_EQ(NotchShare(shares, -1.0), 0.0);
  EXPECT_NEAR(NotchShare(shares, 0.5), 0.05, 1e-15);
  EXPECT_EQ(NotchShare(shares, 1.0), 0.1);
  EXPECT_EQ(NotchShare(shares, 2.0), 0.4);
  EXPECT_NEAR(NotchShare(shares, 2.25), 0.55, 1e-15);
  EXPECT_EQ(NotchShare(shares, 3.0), 1.0);
  EXPECT_EQ(NotchShare(shares, 9.0), 1.0);
}

TEST(TractiveEffort, IsTheSmallestOfItsLimits) {
  TractiveEffortParams p;
  p.starting_effort_n = 800e3;
  p.rim_power_w = 3.0e6;
  p.usable_adhesion.law = UsableAdhesionLaw::kConstant;
  p.usable_adhesion.coefficient = 0.36;
  EXPECT_EQ(TractiveEffort(p, 8, 0.0, 1e9), 800e3);
  EXPECT_EQ(TractiveEffort(p, 4, 0.0, 1e9), 400e3);
  EXPECT_NEAR(TractiveEffort(p, 8, 10.0, 1e9), 300e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 8, -10.0, 1e9), 300e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 5, 10.0, 1e9), 0.4923 * 300e3, 1e-9);  // a C44-9W's notch 5
  EXPECT_NEAR(TractiveEffort(p, 8, 0.0, 1e6), 360e3, 1e-9);            // adhesion
  p.table = EffortTableParams{{0.0, 36.0, 72.0}, {500e3, 250e3, 100e3}};
  EXPECT_EQ(TractiveEffort(p, 8, 0.0, 1e9), 500e3);
  EXPECT_NEAR(TractiveEffort(p, 8, 5.0, 1e9), 375e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 8, 40.0, 1e9), 50e3, 1e-9);  // beyond the table, constant power
  EXPECT_EQ(TractiveEffort(p, 0, 5.0, 1e9), 0.0);
}

TEST(TractiveEffort, LargestPowerOfATableLiesOnItsPointsOrBetween) {
  // Between 0 and 20 m/s, v (300 - 10 v) is largest at 15 m/s: 2250 kW.
  EXPECT_NEAR((EffortTableParams{{0.0, 72.0}, {300e3, 100e3}}.LargestPower()), 2.25e6, 1e-6);
  EXPECT_NEAR((EffortTableParams{{0.0, 36.0}, {300e3, 290e3}}.LargestPower()), 2.9e6, 1e-6);
  EXPECT_NEAR((EffortTableParams{{10.0, 36.0}, {300e3, 300e3}}.LargestPower()), 3.0e6, 1e-6);
}

TEST(TractionParams, BadTablesAreRefused) {
  TractionParams p = QuickLocomotive(1e5, 1e6);
  EXPECT_NO_THROW(strict_config::Validate(p));
  const auto expect_refused = [&p](const std::function<void(TractionParams&)>& spoil,
                                   const std::string& words) {
    TractionParams bad = p;
    spoil(bad);
    try {
      strict_config::Validate(bad);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  expect_refused([](TractionParams& b) { b.tractive_effort.throttle.effort_share[3] = 0.1; },
                 "tractive_effort.throttle.effort_share must ascend from notch to notch");
  expect_refused([](TractionParams& b) { b.tractive_effort.throttle.power_share.pop_back(); },
                 "must have as many values as effort_share");
  expect_refused([](TractionParams& b) { b.tractive_effort.table = EffortTableParams{}; },
                 "tractive_effort.table.speed_kmh must list the speeds of the table");
  expect_refused([](TractionParams& b) { b.tractive_effort.rim_power_w = 0.0; },
                 "tractive_effort.rim_power_w must be > 0, got 0");
  expect_refused(
      [](TractionParams& b) {
        b.tractive_effort.table = EffortTableParams{{0, 10}, {1e5, 2e5}};
      },
      "tractive_effort.table.effort_n must not ascend");
  expect_refused([](TractionParams& b) { b.driven_wheelsets = {2, 1}; }, "driven_wheelsets must ascend");
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

TEST(StepDrive, KeepsItsRates) {
  const DriveParams p = {40e3, 100e3, 10.0};
  DriveState s;
  for (int i = 0; i < 1000; ++i) StepDrive(p, 300e3, 1e-3, s);  // 1 s
  EXPECT_NEAR(s.effort_n, 40e3, 1e-6);
  for (int i = 0; i < 10000; ++i) StepDrive(p, 300e3, 1e-3, s);
  EXPECT_EQ(s.effort_n, 300e3);
  for (int i = 0; i < 500; ++i) StepDrive(p, 0.0, 1e-3, s);  // 0.5 s
  EXPECT_NEAR(s.effort_n, 250e3, 1e-6);
}

TEST(StepDrive, RestsWithoutEffortBetweenTractionAndDynamicBrake) {
  const DriveParams p = {1e5, 1e5, 10.0};
  constexpr double kDt = 1e-3;
  DriveState s;
  for (int i = 0; i < 5000; ++i) StepDrive(p, 200e3, kDt, s);
  EXPECT_EQ(s.effort_n, 200e3);
  double zero_from_s = -1.0, brake_from_s = -1.0;
  for (int i = 1; i <= 20000; ++i) {
    StepDrive(p, -200e3, kDt, s);
    if (s.effort_n == 0.0 && zero_from_s < 0.0) zero_from_s = kDt * i;
    if (s.effort_n < 0.0 && brake_from_s < 0.0) brake_from_s = kDt * i;
  }
  EXPECT_NEAR(zero_from_s, 2.0, 1.5 * kDt);  // 200 kN at 100 kN/s
  EXPECT_NEAR(brake_from_s - zero_from_s, 10.0, 2.0 * kDt);
  EXPECT_EQ(s.effort_n, -200e3);
  for (int i = 0; i < 5000; ++i) StepDrive(p, 0.0, kDt, s);  // 2 s down, 3 s at rest
  for (int i = 0; i < 6900; ++i) StepDrive(p, 100e3, kDt, s);
  EXPECT_EQ(s.effort_n, 0.0);  // the time at rest counts, whatever the controller stood at
  for (int i = 0; i < 200; ++i) StepDrive(p, 100e3, kDt, s);
  EXPECT_GT(s.effort_n, 0.0);
  EXPECT_EQ(s.side, 1.0);
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

TEST(EnergySupply, TakesPowerOverEfficiency) {
  EnergySupplyParams p;
  p.power_share = {0.1, 0.5, 1.0};
  p.efficiency = {0.2, 0.36, 0.4};
  p.idle_power_w = 20e3;
  EXPECT_EQ(PowerTaken(p, 0.0, 2e6), 20e3);
  EXPECT_NEAR(PowerTaken(p, 1e6, 2e6), 20e3 + 1e6 / 0.36, 1e-6);
  EXPECT_NEAR(PowerTaken(p, 1.5e6, 2e6), 20e3 + 1.5e6 / 0.38, 1e-6);
  EXPECT_EQ(PowerTaken(p, -1e6, 2e6), 20e3);
  p.recovered_share = 0.6;
  EXPECT_NEAR(PowerTaken(p, -1e6, 2e6), 20e3 - 0.6e6, 1e-9);
}

// Effort of a C44AC in notch 8 off its own meter, at six speeds (A. Krug, Railroad Facts): a constant power of
// 3.03 MW at the rims stands for it within 3 %.
TEST(TractiveEffort, C44acAtSixSpeeds) {
  const std::vector<double> mph = {15, 20, 25, 30, 35, 40},
                            effort_lbf = {100000, 77000, 61000, 51000, 44000, 38000};
  TractiveEffortParams p = QuickLocomotive(800e3, 3.03e6).tractive_effort;
  for (std::size_t i = 0; i < mph.size(); ++i) {
    const double measured_n = 4.44822 * effort_lbf[i];
    EXPECT_NEAR(TractiveEffort(p, 8, 0.44704 * mph[i], 1.85e6), measured_n, 0.03 * measured_n) << mph[i];
  }
}

}  // namespace
}  // namespace train_dynamics
