#include "train_dynamics/brake/brake_wave.h"

#include <gtest/gtest.h>

#include <limits>

namespace train_dynamics {
namespace {

TEST(FirstWave, TravelsFromItsSource) {
  const WaveArrival first = FirstWave(3.0, -500.0, {{0.0, 0.5}}, 250.0);
  EXPECT_EQ(first.time_s, 3.0 + 0.5 + 2.0);
  EXPECT_EQ(first.distance_m, 500.0);
  EXPECT_EQ(FirstWave(3.0, 0.0, {{0.0, 0.5}}, 250.0).time_s, 3.5);
}

TEST(FirstWave, TheEarliestOfSeveralSourcesCounts) {
  const std::vector<WaveSource> sources = {{0.0, 0.0}, {-1000.0, 1.5}};
  // Where 0 + x/200 = 1.5 + (1000 - x)/200, at 650 m, the waves meet.
  EXPECT_EQ(FirstWave(0.0, -600.0, sources, 200.0).distance_m, 600.0);
  EXPECT_EQ(FirstWave(0.0, -700.0, sources, 200.0).distance_m, 300.0);
  EXPECT_EQ(FirstWave(0.0, -700.0, sources, 200.0).time_s, 3.0);
  // A faster wave of the first source reaches further before they meet: 0 + x/400 = 1.5 + (1000 - x)/400, at 800 m.
  EXPECT_EQ(FirstWave(0.0, -700.0, sources, 400.0).distance_m, 700.0);
}

TEST(FirstWave, DependsOnTheDistanceOnlyNotOnTheSideOrTheOrigin) {
  EXPECT_EQ(FirstWave(0.0, 300.0, {{100.0, 0.0}}, 50.0).time_s, FirstWave(0.0, -100.0, {{100.0, 0.0}}, 50.0).time_s);
  EXPECT_EQ(FirstWave(0.0, 1300.0, {{1100.0, 0.0}}, 50.0).time_s, 4.0);
}

TEST(FirstWave, NeverArrivesWithoutSources) {
  EXPECT_EQ(FirstWave(1.0, 0.0, {}, 100.0).time_s, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace train_dynamics
