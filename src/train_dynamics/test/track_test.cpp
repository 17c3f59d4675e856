// What is under a wheel, looked up in a track of many entries, against a scan of all entries; the ramps of patches
// against their definition; the laws over lanes against those over double.
#include "train_dynamics/track/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

AdhesionParams Surface(double mu0, double a, double b, double ka, double ks) {
  AdhesionParams surface;
  surface.friction_coefficient = mu0;
  surface.friction_ratio = a;
  surface.friction_decay_s_per_m = b;
  surface.adhesion_reduction = ka;
  surface.slip_reduction = ks;
  return surface;
}

const AdhesionParams kOwn = Surface(0.4, 0.8, 0.1, 0.9, 0.5);
const AdhesionParams kLeaves = Surface(0.05, 0.4, 0.2, 0.3, 0.1);

std::array<double, 5> Numbers(const AdhesionParams& p) {
  return {p.friction_coefficient, p.friction_ratio, p.friction_decay_s_per_m, p.adhesion_reduction,
          p.slip_reduction};
}

FrictionPatchParams Leaves(double from_m, double to_m, double ramp_m) {
  FrictionPatchParams patch;
  patch.from_m = from_m;
  patch.to_m = to_m;
  patch.adhesion = kLeaves;
  patch.ramp_length_m = ramp_m;
  return patch;
}

// ---- pieces
// ---------------------------------------------------------------------------------------------------------

// The number of cuts at or before a position, counted one by one.
int Counted(const std::vector<double>& cuts, double x) {
  std::vector<double> distinct = cuts;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return static_cast<int>(std::count_if(distinct.begin(), distinct.end(), [x](double c) { return c <= x; }));
}

void ExpectCounted(const std::vector<double>& cuts, std::vector<double> positions) {
  const Pieces pieces(cuts);
  for (const double cut : cuts) {
    for (const double x : {cut, std::nextafter(cut, -kInfinity), std::nextafter(cut, kInfinity)}) {
      positions.push_back(x);
    }
  }
  for (const double x : positions) {
    const int number = pieces.NumberAt(x);
    ASSERT_EQ(number, Counted(cuts, x)) << x;
    EXPECT_LE(pieces[number].from_m, x);
    EXPECT_TRUE(x < pieces[number].to_m || x == kInfinity);
  }
}

TEST(Pieces, AreThoseOfAScan) {
  std::mt19937 random(1);
  for (const int count : {0, 1, 2, 3, 17, 300}) {
    for (const double length : {1.0, 1e3, 1e7}) {
      std::uniform_real_distribution<double> along(-length, length);
      std::vector<double> cuts, positions = {-kInfinity, kInfinity, 0.0, -0.0, 1e308, -1e308};
      for (int i = 0; i < count; ++i) cuts.push_back(along(random));
      for (int i = 0; i < 100; ++i) positions.push_back(1.5 * along(random));
      ExpectCounted(cuts, positions);
    }
  }
}

TEST(Pieces, OfCutsThatCrowdLieFarApartOrCoincide) {
  std::vector<double> crowd = {-1e9, 1e9, 5.0, 5.0, 5.0};
  for (int i = 0; i < 100; ++i) crowd.push_back(1e-9 * i);
  ExpectCounted(crowd, {0.5e-9, 1.0, 6.0});
  ExpectCounted({-1.7e308, 0.0, 1.7e308}, {1.0, -1.0});
  ExpectCounted({0.0, 5e-324, 1e-323}, {1.0, -1.0});
  ExpectCounted({100.0, 100.0 + 1e-13}, {100.0 + 5e-14});
  const Pieces pieces({1.0, 2.0});
  const int of_nan = pieces.NumberAt(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(of_nan >= 0 && of_nan < pieces.count());
}

// ---- a track of many entries
// ----------------------------------------------------------------------------------------

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
        positions.insert(positions.end(),
                         {end, std::nextafter(end, kInfinity), std::nextafter(end, -kInfinity)});
      }
    }
    for (int direction : {1, -1}) {
      std::sort(positions.begin(), positions.end(),
                [&](double a, double b) { return direction * a < direction * b; });
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

TEST(Track, GivesEveryLaneWhatItGivesOneVehicle) {
  constexpr int kCount = 4;
  using Pack = Lanes<kCount>;
  TrackParams params = RandomTrack(7, 60, 100.0);
  params.dips.pop_back();  // the valley: now there are flat stretches too
  const std::vector<FrictionPatchParams> random_patches = params.friction_patches;
  for (const bool with_leaves : {false, true}) {
    params.friction_patches = random_patches;
    if (with_leaves)
      params.friction_patches = {Leaves(-50.0, -20.0, 2.0), Leaves(-20.0, 3.0, 1.0), {10.0, 60.0, 0.2}};
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
          const std::array<double, 5> expected = Numbers(track.SurfaceAt(at[lane], kOwn));
          ASSERT_EQ(surface.friction[lane], expected[0]) << at[lane];
          const CreepShape<Pack> by_lane = ShapeOf(surface);
          const std::array<double, 4> shape = {by_lane.friction_ratio[lane], by_lane.friction_decay[lane],
                                               by_lane.adhesion_reduction[lane],
                                               by_lane.slip_reduction[lane]};
          for (int i = 0; i < 4; ++i) ASSERT_EQ(shape[i], expected[i + 1]) << at[lane];
        }
      }
    }
  }
}

// ---- patches with a surface of their own
// ----------------------------------------------------------------------------

TEST(RailPatch, RampsGoLinearlyAroundItsEnds) {
  TrackParams params;
  params.friction_patches = {Leaves(100.0, 200.0, 4.0)};
  const Track track(params);
  const std::array<double, 5> own = Numbers(kOwn), leaves = Numbers(kLeaves);
  for (double x = 90.0; x < 210.0; x += 0.01) {
    const double up = std::clamp((x - 98.0) / 4.0, 0.0, 1.0), down = std::clamp((x - 198.0) / 4.0, 0.0, 1.0);
    const std::array<double, 5> found = Numbers(track.SurfaceAt(x, kOwn));
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(found[i], own[i] + (up - down) * (leaves[i] - own[i]), 1e-13)
          << x;  // rounding of (x - 98) / 4
    }
  }
  // The middle of a ramp is the end of the patch.
  EXPECT_NEAR(track.SurfaceAt(100.0, kOwn).friction_coefficient, 0.5 * (0.4 + 0.05), 1e-15);
}

TEST(RailPatch, ADefaultRampIsOneMetreAndFrictionAloneHasNone) {
  TrackParams params;
  params.friction_patches = {Leaves(100.0, 200.0, 0.0), {300.0, 400.0, 0.1}};
  params.friction_patches[0].ramp_length_m.reset();
  const Track track(params);
  EXPECT_EQ(track.SurfaceAt(99.499, kOwn).friction_coefficient, 0.4);
  EXPECT_EQ(track.SurfaceAt(100.501, kOwn).friction_coefficient, 0.05);
  EXPECT_LT(track.SurfaceAt(99.51, kOwn).friction_coefficient, 0.4);
  EXPECT_GT(track.SurfaceAt(100.49, kOwn).friction_coefficient, 0.05);
  EXPECT_EQ(track.SurfaceAt(std::nextafter(300.0, 0.0), kOwn).friction_coefficient, 0.4);
  EXPECT_EQ(track.SurfaceAt(300.0, kOwn).friction_coefficient, 0.1);
}

TEST(RailPatch, NeighboursRampIntoEachOther) {
  TrackParams params;
  params.friction_patches = {Leaves(0.0, 50.0, 2.0), Leaves(50.0, 100.0, 6.0)};
  params.friction_patches[1].adhesion = Surface(0.1, 0.5, 0.3, 0.4, 0.2);
  const Track track(params);
  // Over the longer ramp, and never up to the vehicle's own 0.4 between them.
  EXPECT_EQ(track.SurfaceAt(46.999, kOwn).friction_coefficient, 0.05);
  EXPECT_NEAR(track.SurfaceAt(50.0, kOwn).friction_coefficient, 0.075, 1e-15);
  EXPECT_NEAR(track.SurfaceAt(48.5, kOwn).friction_decay_s_per_m, 0.225, 1e-15);
  EXPECT_EQ(track.SurfaceAt(53.001, kOwn).friction_coefficient, 0.1);
}

TEST(RailPatch, RampsMustFit) {
  const auto errors = [](std::vector<FrictionPatchParams> patches) -> std::string {
    TrackParams params;
    params.friction_patches = std::move(patches);
    try {
      strict_config::Validate(params);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(errors({Leaves(0.0, 10.0, 4.0), Leaves(14.0, 20.0, 4.0)}), "");  // the ramps just meet
  EXPECT_EQ(errors({Leaves(0.0, 1.0, 1.0)}), "");
  EXPECT_EQ(errors({Leaves(0.1, 1.1, 1.0), Leaves(2.1, 3.1, 1.0)}), "") << "rounding is not the user's";
  EXPECT_EQ(errors({Leaves(0.0, 10.0, 4.0), Leaves(13.5, 20.0, 4.0)})
                .find("friction_patches[1].ramp_length_m must leave room to the next change of the surface"),
            0u);
  EXPECT_NE(
      errors({Leaves(0.0, 10.0, 4.0), Leaves(13.5, 20.0, 4.0)}).find("at 10 m (4 m long) and 13.5 m (4 m)"),
      std::string::npos);
  EXPECT_EQ(errors({Leaves(0.0, 3.0, 4.0)}).find("friction_patches[0].ramp_length_m"), 0u);
  // A sharp neighbour has no ramp, but the other's ramp must stay clear of it.
  EXPECT_EQ(errors({{0.0, 10.0, 0.1}, Leaves(10.4, 20.0, 1.0)}).find("friction_patches[1].ramp_length_m"),
            0u);
  EXPECT_EQ(errors({Leaves(0.0, 10.0, 1.0), {10.4, 20.0, 0.1}}).find("friction_patches[0].ramp_length_m"),
            0u);
}

TEST(RailPatch, NeedsOneOfFrictionAndAdhesion) {
  TrackParams params;
  params.friction_patches = {Leaves(0.0, 10.0, 1.0)};
  params.friction_patches[0].friction_coefficient = 0.2;
  EXPECT_THROW(strict_config::Validate(params), std::invalid_argument);
  params.friction_patches[0].friction_coefficient.reset();
  EXPECT_NO_THROW(strict_config::Validate(params));
  params.friction_patches[0].adhesion.reset();
  EXPECT_THROW(strict_config::Validate(params), std::invalid_argument);
}

// A pack whose vehicles are on different surfaces takes another way through the creep law: the bits are the same.
TEST(RailPatch, MixedPacksGiveTheBitsOfSingleWagons) {
  constexpr int kCount = 4;
  using Pack = Lanes<kCount>;
  VehicleParams params = OreWagon();
  params.brake_rigging.shoe_load_per_pressure_n_per_pa *= 2.5;
  const Wagon wagon(params);  // its own surface does not fall over the slip, that of the patch does
  TrackParams track_params;
  track_params.friction_patches = {Leaves(30.0, 60.0, 3.0), {70.0, 75.0, 0.1}, Leaves(80.0, 90.0, 1.0)};
  const Track track(track_params);
  std::array<WagonState<double>, kCount> scalar;
  for (int lane = 0; lane < kCount; ++lane) scalar[lane] = StaticEquilibrium(wagon, -10.5 * lane, 18.0);
  WagonState<Pack> packed;
  const auto lane_of = [](auto& state, int i) -> double& { return reinterpret_cast<double*>(&state)[i]; };
  constexpr int kNumbers = sizeof(WagonState<double>) / sizeof(double);
  const auto pack_number = [&](int i, int lane) -> double& {
    return reinterpret_cast<double*>(&packed)[i * kCount + lane];
  };
  for (int i = 0; i < kNumbers; ++i) {
    for (int lane = 0; lane < kCount; ++lane) pack_number(i, lane) = lane_of(scalar[lane], i);
  }
  int mixed_steps = 0;
  for (int step = 0; step < 6000; ++step) {
    VehicleLoads<double> loads;
    loads.cylinder_pressure_pa = 4e5;
    WagonOutput<double>* const none = nullptr;
    for (WagonState<double>& s : scalar) StepWagon(wagon, track, loads, 1e-3, s, none);
    VehicleLoads<Pack> pack_loads{};
    pack_loads.cylinder_pressure_pa = Pack(4e5);
    WagonOutput<Pack>* const no_output = nullptr;
    StepWagon(wagon, track, pack_loads, 1e-3, packed, no_output);
    mixed_steps +=
        RailSurfaceUnder(track, packed.origin_m + packed.position.x[kWheelset1], kOwn).adhesion == nullptr;
    for (int i = 0; i < kNumbers; ++i) {
      for (int lane = 0; lane < kCount; ++lane) {
        ASSERT_EQ(lane_of(scalar[lane], i), pack_number(i, lane)) << "number " << i << ", step " << step;
      }
    }
  }
  EXPECT_GT(mixed_steps, 1000);
}

// ---- limits of soundness
// --------------------------------------------------------------------------------------------

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
  steep.dips = {{0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0},
                {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0},
                {0.0, -1.0, 60.0}, {0.0, -1.0, 60.0}};
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
