// Limits beyond which a vehicle is not sound, counted from the rail.

#include "train_dynamics/vehicle/state_limits.h"

#include <gtest/gtest.h>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

TEST(Soundness, CountsFromTheRail) {
  const Wagon wagon(OreWagon());
  TrackParams valley;
  valley.dips = {{100.0, 1.0, 300.0}, {100.0, 1.0, 300.0}, {100.0, 1.0, 300.0}};  // 3 m deep together
  const Track track(valley), level;
  WagonState<double> s = StaticEquilibrium(wagon, 250.0, 20.0);
  EXPECT_TRUE(IsSound(wagon, level, s));
  EXPECT_FALSE(IsSound(wagon, track, s)) << "3 m above the rail";
  for (double& z : s.position.z) z -= 3.0;
  EXPECT_TRUE(IsSound(wagon, track, s));
  EXPECT_FALSE(IsSound(wagon, level, s)) << "3 m below the rail";
  s.position.z[kWheelset2] += 1.01;
  EXPECT_FALSE(IsSound(wagon, track, s)) << "a wheelset 1 m above its rail";
}

TEST(Soundness, PitchCountsFromTheRailsSlope) {
  const Wagon wagon(OreWagon());
  TrackParams steep;  // down at up to pi 1 m / 6 m = 0.52: over bogies 7 m apart a line of other slope
  steep.dips = {{0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0},
                {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}};
  const Track track(steep);
  // Halfway down the 10 m high hump the rail falls by 10 pi / 60 = 0.5236.
  WagonState<double> s = StaticEquilibrium(wagon, 45.0, 5.0);
  const double bogie = wagon.bogie_offset_m[0];
  const auto mean = [&](double x) {
    const double half = OreWagon().half_wheelset_spacing_m;
    return 0.5 * (RailHeightAt(track, x - half).height + RailHeightAt(track, x + half).height);
  };
  const double slope = (mean(45.0 - bogie) - mean(45.0 + bogie)) / (2.0 * bogie);
  ASSERT_GT(slope, 0.5);
  for (int b = 0; b < kBodies; ++b) {
    double at = 45.0;
    if (b >= kWheelset1) {
      at += wagon.wheelset_offset_m[b - kWheelset1];
    } else if (b != kCarbody) {
      at += wagon.bogie_offset_m[(b - kFrontBolster) % 2];
    }
    s.position.z[b] += RailHeightAt(track, at).height;
    if (b < kWheelset1) s.position.pitch[b] += slope;  // nose down
  }
  EXPECT_TRUE(IsSound(wagon, track, s));
  s.position.pitch[kCarbody] -= 2.0 * slope;  // nose up on a falling rail
  EXPECT_FALSE(IsSound(wagon, track, s));
}

}  // namespace
}  // namespace train_dynamics
