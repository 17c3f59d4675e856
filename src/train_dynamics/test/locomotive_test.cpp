#include "train_dynamics/traction/locomotive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "locomotive_ride.h"
#include "strict_config/validate.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

TEST(Traction, AcceleratesAsTheClosedFormSays) {
  // M v1 / F + M (v2^2 - v1^2) / 2P and M v1^2 / 2F + M (v2^3 - v1^3) / 3P, corner v1 = P / F = 3.75 m/s.
  const double f = 800e3, power = 3.0e6, v1 = power / f, v2 = 20.0;
  const double time_s = kMass * v1 / f + kMass * (v2 * v2 - v1 * v1) / (2.0 * power);
  const double way_m = kMass * v1 * v1 / (2.0 * f) + kMass * (std::pow(v2, 3) - std::pow(v1, 3)) / (3.0 * power);
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
