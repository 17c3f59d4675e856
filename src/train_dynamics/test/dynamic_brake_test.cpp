#include "train_dynamics/traction/dynamic_brake.h"

#include <gtest/gtest.h>

#include <functional>

#include "locomotive_ride.h"
#include "strict_config/validate.h"
#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

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
