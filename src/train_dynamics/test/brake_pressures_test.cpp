#include "train_dynamics/brake/brake_pressures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "paper_vehicle.h"
#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

constexpr int kVehicles = 20;
constexpr double kStep = 5e-4;  // [s], half an exchange
constexpr int kWindow = 20;     // steps, a record interval

// A service application, a further one and a release.
AirBrake Brake() {
  std::vector<double> centres;
  for (int i = 0; i < kVehicles; ++i) centres.push_back(-10.5 * i);
  AirBrakeParams params = LoadPart<BrakeSystemParams>("brakes/calibrated.yaml").empirical;
  params.sources = {{"lead", 1, 0.0, true, 0.0}};
  return AirBrake(params,
                  {{0.5, BrakeCommandKind::kApply, 70.0},
                   {4.0, BrakeCommandKind::kApply, 170.0},
                   {9.0, BrakeCommandKind::kRelease}},
                  centres);
}

TEST(BrakePressures, AreTheLawsUpToRounding) {
  const AirBrake brake = Brake();
  BrakePressures pressures(Brake(), kStep, kWindow);
  std::vector<double> stepped, law;
  double largest_pa = 0.0;
  for (long h = 0; h < 24000; ++h) {  // 12 s
    const double time_s = static_cast<double>(h) * kStep;
    pressures.PressuresAt(time_s, stepped);
    brake.PressuresAt(time_s, law);
    ASSERT_EQ(stepped.size(), law.size());
    for (int i = 0; i < kVehicles; ++i) {
      // Of a gap up to 430 kPa: each step rounds it once (half an ulp, 1.1e-16) and has a factor that is off by
      // an ulp; the law's own exponential is off by an ulp, too.
      ASSERT_NEAR(stepped[i], law[i], 430e3 * (1.5 * kWindow + 4.0) * 2.3e-16) << "h = " << h;
      largest_pa = std::max(largest_pa, law[i]);
    }
  }
  EXPECT_GT(largest_pa, 100e3);
}

TEST(BrakePressures, DependOnTheTimeAloneNotOnWhatWasAskedBefore) {
  BrakePressures in_order(Brake(), kStep, kWindow);
  BrakePressures at_random(Brake(), kStep, kWindow);
  std::vector<std::vector<double>> expected;
  for (long h = 0; h < 24000; ++h) {
    expected.emplace_back();
    in_order.PressuresAt(static_cast<double>(h) * kStep, expected.back());
  }
  std::vector<double> pressure;
  long h = 7;
  for (int i = 0; i < 24000; ++i) {
    at_random.PressuresAt(static_cast<double>(h) * kStep, pressure);
    ASSERT_EQ(pressure, expected[h]) << "h = " << h;
    h = i % 3 == 0 ? (h * 7919 + 13) % 24000 : std::min(h + i % 3, 23999L);  // jumps, and a step or two ahead
  }
}

}  // namespace
}  // namespace train_dynamics
