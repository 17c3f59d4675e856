#include "train_dynamics/traction/drive.h"

#include <gtest/gtest.h>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

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

}  // namespace
}  // namespace train_dynamics
