// Patches of rail: what holds under a wheel, and their ramps against their definition.

#include "train_dynamics/track/friction_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "leaves_on_rail.h"
#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

TEST(FrictionPatch, ReplacesTheVehiclesOwn) {
  AdhesionParams own;
  own.friction_coefficient = 0.4;
  const auto friction_at = [&own](const Track& track, double x) {
    return track.SurfaceAt(x, own).friction_coefficient;
  };
  TrackParams track;
  EXPECT_EQ(friction_at(track, 5.0), 0.4);
  track.friction_patches = {{0.0, 100.0, 0.05}, {50.0, 60.0, 0.3}};
  EXPECT_EQ(friction_at(track, -0.001), 0.4);
  EXPECT_EQ(friction_at(track, 0.0), 0.05);
  EXPECT_EQ(friction_at(track, 55.0), 0.3);  // the later entry holds
  EXPECT_EQ(friction_at(track, 60.0), 0.05);
  EXPECT_EQ(friction_at(track, 100.0), 0.4);
  EXPECT_EQ(RailSurfaceUnder<double>(track, 55.0, own).friction, 0.3);
}

TEST(RailPatch, RampsGoLinearlyAroundItsEnds) {
  TrackParams params;
  params.friction_patches = {Leaves(100.0, 200.0, 4.0)};
  const Track track(params);
  const std::array<double, 5> own = AdhesionNumbers(kOwn), leaves = AdhesionNumbers(kLeaves);
  for (double x = 90.0; x < 210.0; x += 0.01) {
    const double up = std::clamp((x - 98.0) / 4.0, 0.0, 1.0), down = std::clamp((x - 198.0) / 4.0, 0.0, 1.0);
    const std::array<double, 5> found = AdhesionNumbers(track.SurfaceAt(x, kOwn));
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(found[i], own[i] + (up - down) * (leaves[i] - own[i]), 1e-13) << x;  // rounding of (x - 98) / 4
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
  // The longer ramp applies, and friction never reaches the vehicle's own 0.4 between the patches.
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
  EXPECT_NE(errors({Leaves(0.0, 10.0, 4.0), Leaves(13.5, 20.0, 4.0)}).find("at 10 m (4 m long) and 13.5 m (4 m)"),
            std::string::npos);
  EXPECT_EQ(errors({Leaves(0.0, 3.0, 4.0)}).find("friction_patches[0].ramp_length_m"), 0u);
  // A sharp neighbour has no ramp, but the other's ramp must stay clear of it.
  EXPECT_EQ(errors({{0.0, 10.0, 0.1}, Leaves(10.4, 20.0, 1.0)}).find("friction_patches[1].ramp_length_m"), 0u);
  EXPECT_EQ(errors({Leaves(0.0, 10.0, 1.0), {10.4, 20.0, 0.1}}).find("friction_patches[0].ramp_length_m"), 0u);
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
    mixed_steps += RailSurfaceUnder(track, packed.origin_m + packed.position.x[kWheelset1], kOwn).adhesion == nullptr;
    for (int i = 0; i < kNumbers; ++i) {
      for (int lane = 0; lane < kCount; ++lane) {
        ASSERT_EQ(lane_of(scalar[lane], i), pack_number(i, lane)) << "number " << i << ", step " << step;
      }
    }
  }
  EXPECT_GT(mixed_steps, 1000);
}

}  // namespace
}  // namespace train_dynamics
