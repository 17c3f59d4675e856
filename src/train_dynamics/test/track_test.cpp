// What is under a wheel, looked up in a track of many entries, against a scan of all entries; over lanes against one by
// one.

#include "train_dynamics/track/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "leaves_on_rail.h"
#include "strict_config/validate.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Entries that touch, overlap, lie in one another and leave gaps.
TrackParams RandomTrack(unsigned seed, int entries, double length_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-length_m, length_m), share(0.0, 1.0);
  std::uniform_int_distribution<int> metre(static_cast<int>(-length_m), static_cast<int>(length_m));
  TrackParams track;
  for (int i = 0; i < entries; ++i) {
    const bool on_metres = i % 2 == 0;  // so that many ends coincide
    const double from = on_metres ? metre(random) : along(random);
    const double length = on_metres ? 1.0 + std::floor(6.0 * share(random)) : 0.01 + 8.0 * share(random);
    track.dips.push_back({from, 0.02 * share(random) - 0.01, length});
    track.friction_patches.push_back({from, from + length, 0.02 + 0.3 * share(random)});
    track.grades.push_back({from, 4.0 * share(random) - 2.0});
  }
  track.dips.push_back({-length_m, 0.5, 2.0 * length_m});  // a valley around all of them
  const auto before = [](const GradeParams& a, const GradeParams& b) { return a.from_m < b.from_m; };
  const auto same = [](const GradeParams& a, const GradeParams& b) { return a.from_m == b.from_m; };
  std::sort(track.grades.begin(), track.grades.end(), before);
  track.grades.erase(std::unique(track.grades.begin(), track.grades.end(), same), track.grades.end());
  return track;
}

// What the entries mean, entry by entry.
double ScannedGrade(const TrackParams& track, double x) {
  double percent = track.grades.front().grade_percent;
  for (const GradeParams& grade : track.grades) {
    if (x >= grade.from_m) percent = grade.grade_percent;
  }
  return 0.01 * percent;
}
RailHeight<double> ScannedHeight(const TrackParams& track, double x) {
  RailHeight<double> sum{0.0, 0.0};
  for (const DipParams& dip : track.dips) {
    const RailHeight<double> one = DipHeight(dip, x);
    sum.height += one.height;
    sum.slope += one.slope;
  }
  return sum;
}
double ScannedFriction(const TrackParams& track, double x) {
  double friction = kOwn.friction_coefficient;
  for (const FrictionPatchParams& patch : track.friction_patches) {
    if (x >= patch.from_m && x < patch.to_m) friction = *patch.friction_coefficient;
  }
  return friction;
}

TEST(Track, GivesTheBitsOfAScanInBothDirections) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const TrackParams params = RandomTrack(seed, 120, 150.0);
    const Track track(params);
    std::vector<double> positions;
    for (double x = -170.0; x < 170.0; x += 0.0371) positions.push_back(x);
    for (const DipParams& dip : params.dips) {
      for (const double end : {dip.from_m, dip.from_m + dip.length_m}) {
        positions.insert(positions.end(), {end, std::nextafter(end, kInfinity), std::nextafter(end, -kInfinity)});
      }
    }
    for (int direction : {1, -1}) {
      std::sort(positions.begin(), positions.end(), [&](double a, double b) { return direction * a < direction * b; });
      for (const double x : positions) {
        ASSERT_EQ(GradeAt(track, x), ScannedGrade(params, x)) << x;
        ASSERT_EQ(RailHeightAt(track, x).height, ScannedHeight(params, x).height) << x;
        ASSERT_EQ(RailHeightAt(track, x).slope, ScannedHeight(params, x).slope) << x;
        const AdhesionParams surface = track.SurfaceAt(x, kOwn);
        ASSERT_EQ(surface.friction_coefficient, ScannedFriction(params, x)) << x;
        ASSERT_EQ(surface.slip_reduction, kOwn.slip_reduction);
      }
    }
  }
}

// A scan of all entries at each place would be 10^11 steps, which no time-out of a test allows.
TEST(Track, OfManyEntriesIsLookedUpWithoutAScan) {
  constexpr int kEntries = 100000, kPlaces = 1000000;
  TrackParams params;
  params.grades.clear();
  for (int i = 0; i < kEntries; ++i) {
    const double from = 2.0 * i;
    params.grades.push_back({from, i % 2 == 0 ? 1.0 : -1.0});
    params.dips.push_back({from, 1e-3, 1.0});
    params.friction_patches.push_back({from, from + 1.0, 0.1});
  }
  const Track track(params);
  int uphill = 0, flat = 0, slippery = 0;
  for (int i = 0; i < kPlaces; ++i) {
    // In turn near and far, as wheels of a long train that look one after the other.
    const double x = std::fmod(i * 0.2 + (i % 7) * 1234.5, 2.0 * kEntries) + 0.05;
    uphill += GradeAt(track, x) > 0.0 ? 1 : 0;
    flat += RailHeightAt(track, x).height == 0.0 ? 1 : 0;
    slippery += track.SurfaceAt(x, kOwn).friction_coefficient == 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(uphill, kPlaces / 2, kPlaces / 100);  // each lies in half of the length
  EXPECT_NEAR(flat, kPlaces / 2, kPlaces / 100);
  EXPECT_EQ(slippery, kPlaces - flat);
}

TEST(Track, GivesEveryLaneWhatItGivesOneVehicle) {
  constexpr int kCount = 4;
  using Pack = Lanes<kCount>;
  TrackParams params = RandomTrack(7, 60, 100.0);
  params.dips.pop_back();  // the valley: now there are flat stretches too
  const std::vector<FrictionPatchParams> random_patches = params.friction_patches;
  for (const bool with_leaves : {false, true}) {
    params.friction_patches = random_patches;
    if (with_leaves) params.friction_patches = {Leaves(-50.0, -20.0, 2.0), Leaves(-20.0, 3.0, 1.0), {10.0, 60.0, 0.2}};
    const Track track(params);
    for (const double apart : {0.0, 0.3, 10.5}) {
      for (double x = -120.0; x < 120.0; x += 0.0773) {
        std::array<double, kCount> at;
        for (int lane = 0; lane < kCount; ++lane) at[lane] = x - apart * lane;
        const Pack positions = Pack::Load(at.data());
        const Pack grade = GradeUnder(track, positions);
        const RailHeight<Pack> rail = RailHeightUnder(track, positions);
        const RailSurface<Pack> surface = RailSurfaceUnder(track, positions, kOwn);
        for (int lane = 0; lane < kCount; ++lane) {
          ASSERT_EQ(grade[lane], GradeAt(track, at[lane]));
          ASSERT_EQ(rail.height[lane], RailHeightAt(track, at[lane]).height);
          ASSERT_EQ(rail.slope[lane], RailHeightAt(track, at[lane]).slope);
          const std::array<double, 5> expected = AdhesionNumbers(track.SurfaceAt(at[lane], kOwn));
          ASSERT_EQ(surface.friction[lane], expected[0]) << at[lane];
          const CreepShape<Pack> by_lane = ShapeOf(surface);
          const std::array<double, 4> shape = {by_lane.friction_ratio[lane], by_lane.friction_decay[lane],
                                               by_lane.adhesion_reduction[lane], by_lane.slip_reduction[lane]};
          for (int i = 0; i < 4; ++i) ASSERT_EQ(shape[i], expected[i + 1]) << at[lane];
        }
      }
    }
  }
}

}  // namespace
}  // namespace train_dynamics
