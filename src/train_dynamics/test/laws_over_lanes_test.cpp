// The laws are templates over their scalar type. Here whole steps run over lanes, and every lane has to give
// the bits that double gives: the promise on which results do not depend on the machine's vector width.
#include <gtest/gtest.h>

#include <array>

#include "paper_vehicle.h"
#include "train_dynamics/coupler/connection.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

constexpr int kCount = 4;
using Pack = Lanes<kCount>;

template <class Get>
Pack Gather(const Get& get) {
  std::array<double, kCount> values;
  for (int lane = 0; lane < kCount; ++lane) values[lane] = get(lane);
  return Pack::Load(values.data());
}

/// Brakes so hard on a slippery patch that wheels lock, a dip and a change of grade on the way.
TrackParams EventfulTrack() {
  TrackParams track;
  track.grades = {{0.0, 0.5}, {30.0, -0.5}};
  track.dips = {{20.0, 0.03, 10.0}};
  track.friction_patches = {{40.0, 120.0, 0.02}};
  return track;
}

double Pressure(int step) { return step < 200 ? 0.0 : 2e6; }

TEST(LawsOverLanes, WagonStepsGiveTheBitsOfDouble) {
  const Wagon wagon(OreWagon());
  const TrackParams track = EventfulTrack();
  std::array<WagonState<double>, kCount> scalar;
  for (int lane = 0; lane < kCount; ++lane) {
    scalar[lane] = StaticEquilibrium(wagon, 3.0 * lane, 20.0 - 6.0 * lane);  // one stands still
    scalar[lane].position.pitch[kCarbody] = 1e-3 * lane;
  }
  WagonState<Pack> packed;
  packed.origin_m = Gather([&](int lane) { return scalar[lane].origin_m; });
  for (int b = 0; b < kBodies; ++b) {
    packed.position.x[b] = Gather([&](int lane) { return scalar[lane].position.x[b]; });
    packed.position.z[b] = Gather([&](int lane) { return scalar[lane].position.z[b]; });
    packed.position.pitch[b] = Gather([&](int lane) { return scalar[lane].position.pitch[b]; });
    packed.velocity.x[b] = Gather([&](int lane) { return scalar[lane].velocity.x[b]; });
    packed.velocity.z[b] = Gather([&](int lane) { return scalar[lane].velocity.z[b]; });
    packed.velocity.pitch[b] = Gather([&](int lane) { return scalar[lane].velocity.pitch[b]; });
  }
  int locked_steps = 0;
  for (int step = 0; step < 6000; ++step) {
    std::array<WagonOutput<double>, kCount> scalar_output;
    for (int lane = 0; lane < kCount; ++lane) {
      VehicleLoads<double> loads;
      loads.front_coupler_n = 1e4 * lane;
      loads.cylinder_pressure_pa = Pressure(step);
      StepWagon(wagon, track, loads, 1e-3, scalar[lane], &scalar_output[lane]);
      if (scalar[lane].velocity.pitch[kWheelset1] == 0.0 && scalar[lane].velocity.x[kCarbody] > 1.0) ++locked_steps;
    }
    VehicleLoads<Pack> loads;
    loads.front_coupler_n = Gather([](int lane) { return 1e4 * lane; });
    loads.cylinder_pressure_pa = Pack(Pressure(step));
    WagonOutput<Pack> packed_output;
    StepWagon(wagon, track, loads, 1e-3, packed, &packed_output);
    for (int lane = 0; lane < kCount; ++lane) {
      ASSERT_EQ(scalar_output[lane].creep_force_n[0], packed_output.creep_force_n[0][lane]) << step;
      ASSERT_EQ(scalar_output[lane].wedge_friction_n[3], packed_output.wedge_friction_n[3][lane]) << step;
      for (int b = 0; b < kBodies; ++b) {
        ASSERT_EQ(scalar[lane].position.x[b], packed.position.x[b][lane]) << kBodyNames[b] << ", step " << step;
        ASSERT_EQ(scalar[lane].velocity.z[b], packed.velocity.z[b][lane]) << kBodyNames[b] << ", step " << step;
        ASSERT_EQ(scalar[lane].velocity.pitch[b], packed.velocity.pitch[b][lane]) << kBodyNames[b] << ", step " << step;
      }
      for (int i = 0; i < kDissipations; ++i) {
        ASSERT_EQ(scalar[lane].work.dissipated[i], packed.work.dissipated[i][lane]) << kDissipationNames[i];
      }
    }
  }
  EXPECT_GT(locked_steps, 0) << "the run should have visited the branch of locked wheels";
}

TEST(LawsOverLanes, LtdStepsGiveTheBitsOfDouble) {
  const LtdVehicle vehicle(OreWagon(), true);
  const TrackParams track = EventfulTrack();
  std::array<LtdState<double>, kCount> scalar;
  for (int lane = 0; lane < kCount; ++lane) scalar[lane].v_mps = 2.0 * lane;
  LtdState<Pack> packed;
  packed.v_mps = Gather([&](int lane) { return scalar[lane].v_mps; });
  for (int step = 0; step < 20000; ++step) {
    VehicleLoads<double> loads;
    loads.cylinder_pressure_pa = Pressure(step);
    for (LtdState<double>& s : scalar) StepLtd(vehicle, track, loads, 1e-3, s);
    VehicleLoads<Pack> packed_loads;
    packed_loads.cylinder_pressure_pa = Pack(Pressure(step));
    StepLtd(vehicle, track, packed_loads, 1e-3, packed);
    for (int lane = 0; lane < kCount; ++lane) {
      ASSERT_EQ(scalar[lane].x_m, packed.x_m[lane]) << step;
      ASSERT_EQ(scalar[lane].v_mps, packed.v_mps[lane]) << step;
      ASSERT_EQ(scalar[lane].work.gravity, packed.work.gravity[lane]) << step;
    }
  }
}

TEST(LawsOverLanes, DraftGearsGiveTheBitsOfDouble) {
  const DraftGear gear(LoadPart<ConnectionParams>("couplers/calibrated.yaml").draft_gear);
  for (int i = -400; i <= 400; ++i) {
    const double q = 5e-4 * i;  // through slack, travel and solid stop on both sides
    const auto rate = [](int lane) { return 0.03 * (lane - 1.5); };
    const GearForce<Pack> packed = SmoothGearForce(gear, Pack(q), Gather(rate));
    std::array<StickState<double>, kCount> scalar_state;
    StickState<Pack> packed_state{Pack(0.001), Pack(0.0)};
    const GearForce<Pack> packed_stick = StickSpringGearForce(gear, Pack(q), Gather(rate), packed_state);
    for (int lane = 0; lane < kCount; ++lane) {
      EXPECT_EQ(SmoothGearForce(gear, q, rate(lane)).force, packed.force[lane]) << q;
      scalar_state[lane] = {0.001, 0.0};
      EXPECT_EQ(StickSpringGearForce(gear, q, rate(lane), scalar_state[lane]).force, packed_stick.force[lane]) << q;
    }
  }
}

}  // namespace
}  // namespace train_dynamics
