// The 2D vehicle with three wheelsets per bogie: the same laws as the wagon's, on eleven bodies.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>

#include "paper_vehicle.h"
#include "ride.h"
#include "strict_config/error_list.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"
#include "train_dynamics/train/vehicle_block.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"
#include "train_dynamics/vehicle/vehicle_batch.h"
#include "train_dynamics/vehicle/wagon_modes.h"

namespace train_dynamics {
namespace {

constexpr int kSixWheelsets = kWheelsetsOf<3>, kElevenBodies = kBodiesOf<3>;
constexpr double kPi = 3.14159265358979323846;

// A locomotive-like vehicle on two three-axle bogies, with the ore wagon's wedges.
VehicleParams WithWedges() {
  VehicleParams p = OreWagon();
  p.name = "six_axle";
  p.length_m = 20.0;
  p.half_bogie_spacing_m = 6.0;
  p.wheelsets_per_bogie = 3;
  p.half_wheelset_spacing_m = 1.85;
  p.carbody = {120e3, 3.1e6, 1.9};
  p.bogie_frame = {8000.0, 12000.0, 0.6};
  return p;
}

// The same on spring nests with linear dampers instead.
VehicleParams WithDampers() {
  VehicleParams p = WithWedges();
  p.friction_wedge.reset();
  p.wedge_mass_kg = 0.0;
  p.spring_nest.inner_stiffness_n_per_m = 0.0;  // linear to solid
  p.spring_nest.stage2_travel_m = 0.1;
  p.spring_nest.damping_ns_per_m = 2e4;
  return p;
}

VehicleParams WithoutResistance(VehicleParams p) {
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  return p;
}

Eigen::VectorXd Row(const BodyVector<double, 3>& b) {
  Eigen::VectorXd row(3 * kElevenBodies);
  for (int i = 0; i < kElevenBodies; ++i) row.segment<3>(3 * i) << b.x[i], b.z[i], b.pitch[i];
  return row;
}
Eigen::VectorXd Row(const ElementVector<double, 3>& e) {
  Eigen::VectorXd row(28);
  row.head<6>() = Eigen::Map<const Eigen::VectorXd>(e.pad_x.data(), 6);
  row.segment<6>(6) = Eigen::Map<const Eigen::VectorXd>(e.pad_z.data(), 6);
  for (int i = 0; i < kQuarters; ++i) row.segment<3>(12 + 3 * i) << e.nest[i], e.wedge[i], e.rim[i];
  row.tail<4>() << e.guide_x[0], e.guide_x[1], e.plate_x[0], e.plate_x[1];
  return row;
}

TEST(SixAxleElements, ForcesAreTheTransposeOfDeflections) {
  VehicleParams p = WithWedges();
  p.middle_wheelset_offset_m = 0.2;
  const SixAxleVehicle w(p);
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<> number(-1.0, 1.0);
  for (int sample = 0; sample < 100; ++sample) {
    BodyVector<double, 3> velocity, on_bodies{};
    for (auto* row : {&velocity.x, &velocity.z, &velocity.pitch})
      for (double& v : *row) v = number(engine);
    ElementVector<double, 3> force;
    for (auto* six : {&force.pad_x, &force.pad_z})
      for (double& f : *six) f = 1e5 * number(engine);
    for (auto* four : {&force.nest, &force.wedge, &force.rim})
      for (double& f : *four) f = 1e5 * number(engine);
    for (auto* two : {&force.guide_x, &force.plate_x})
      for (double& f : *two) f = 1e5 * number(engine);
    AddElementForces(w, force, on_bodies);
    // Rounding of 28 products.
    EXPECT_NEAR(Row(on_bodies).dot(Row(velocity)), -Row(force).dot(Row(ElementsOf(w, velocity))), 1e-7);
  }
}

TEST(SixAxleElements, ARigidMotionDeflectsNothing) {
  VehicleParams p = WithDampers();
  p.middle_wheelset_offset_m = -0.1;
  const SixAxleVehicle w(p);
  const double up[] = {1.9, 0.55, 0.55, 0.6, 0.6, 0.485, 0.485, 0.485, 0.485, 0.485, 0.485};
  // By hand: outer wheelsets at 6 +- 1.85 m; the middle ones 0.1 m nearer to the vehicle's centre than 6 m.
  const double along[] = {0.0, 6.0, -6.0, 6.0, -6.0, 7.85, 5.9, 4.15, -4.15, -5.9, -7.85};
  BodyVector<double, 3> q;
  for (int i = 0; i < kElevenBodies; ++i) {  // 3 m forward, 0.02 m up and 0.01 rad about a point on the rail
    q.x[i] = 3.0 + 0.01 * up[i];
    q.z[i] = 0.02 - 0.01 * along[i];
    q.pitch[i] = 0.01;
  }
  EXPECT_LT(Row(ElementsOf(w, q)).cwiseAbs().maxCoeff(), 1e-14);  // rounding of 3 m
}

TEST(SixAxleStatics, EveryWheelsetCarriesASixth) {
  for (const VehicleParams& p : {WithWedges(), WithDampers()}) {
    const SixAxleVehicle w(p);
    const auto s = StaticEquilibrium(w, 0.0, 20.0);
    const auto rail = ContactForces<true>(w, Track(), {}, s);
    for (int i = 0; i < kSixWheelsets; ++i) EXPECT_NEAR(rail.normal[i], w.weight_n / 6.0, 1e-9 * w.weight_n);
  }
  EXPECT_NEAR(SixAxleVehicle(WithDampers()).weight_n, 9.81 * (120e3 + 2.0 * 1103.9 + 2.0 * 8000.0 + 6.0 * 1731.8),
              1e-6);
}

TEST(SixAxleStatics, AMiddleWheelsetOffTheCentreTakesItsShare) {
  // Pads and contacts are equal springs, so that the pad forces of a bogie lie on a line over the place:
  // P(x) = a + b x, of which sum P is the load and sum x P = 0 about the bogie's centre.
  VehicleParams p = WithDampers();
  p.middle_wheelset_offset_m = 0.3;
  const SixAxleVehicle w(p);
  const double d = 1.85, m = 0.3, wheelset_n = 9.81 * 1731.8;
  const double load = 0.5 * w.weight_n - 3.0 * wheelset_n;
  const auto rail = ContactForces<true>(w, Track(), {}, StaticEquilibrium(w, 0.0, 0.0));
  const double front = rail.normal[0] - wheelset_n, middle = rail.normal[1] - wheelset_n,
               rear = rail.normal[2] - wheelset_n;
  EXPECT_NEAR(front + middle + rear, load, 1e-9 * w.weight_n);
  EXPECT_NEAR(middle, 0.5 * (front + rear) + 0.5 * (front - rear) * m / d, 1e-9 * w.weight_n);
  // The frame leans towards the middle wheelset by 0.2 mrad: the nests' couple against that is 1e-4 of the load's.
  EXPECT_NEAR(d * front + m * middle - d * rear, 0.0, 1e-4 * d * load);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(rail.normal[5 - i], rail.normal[i], 1e-9 * w.weight_n);
  EXPECT_LT(rail.normal[0], rail.normal[2] - 1e3);  // the shorter lever carries more
}

TEST(SixAxleLtd, TurnsSixWheelsets) {
  const VehicleParams p = WithDampers();
  const LtdVehicle with(p, true), without(p, false);
  EXPECT_NEAR(with.inertia_kg - without.inertia_kg, 6.0 * 679.0 / (0.485 * 0.485), 1e-7);
}

TEST(SixAxleModes, BounceAndPitchAreThoseOfACarbodyOnItsNests) {
  VehicleParams p = WithDampers();
  p.spring_nest.damping_ns_per_m = 0.0;
  const WagonModes<3> analysis = AnalyseModes(SixAxleVehicle(p));
  EXPECT_EQ(analysis.rigid_body_modes, 7);  // travel and the rotation of six wheelsets
  EXPECT_EQ(analysis.modes.size(), 3u * kElevenBodies - 7u);
  const double nests = 8.0 * 1590e3;
  const double series = 1.0 / (1.0 / nests + 1.0 / (12.0 * 3e7) + 1.0 / (12.0 * 6e8) + 1.0 / (2.0 * 4e8));
  const double sprung_kg = 120e3 + 2.0 * 1103.9;
  // The frames move along a little: 13 % of the sprung mass with 4 % of the motion.
  const double bounce = std::sqrt(series / sprung_kg) / (2.0 * kPi);
  const double pitch = std::sqrt(series * 6.0 * 6.0 / 3.1e6) / (2.0 * kPi);
  const auto nearest = [&](double frequency_hz, auto share) {
    double best = 1e9;
    for (const auto& mode : analysis.modes) {
      if (share(mode) > 0.8 && std::abs(mode.frequency_hz - frequency_hz) < std::abs(best - frequency_hz))
        best = mode.frequency_hz;
    }
    return best;
  };
  EXPECT_NEAR(nearest(bounce, [](const auto& m) { return m.energy_share.z[kCarbody]; }), bounce, 0.01 * bounce);
  EXPECT_NEAR(nearest(pitch, [](const auto& m) { return m.energy_share.pitch[kCarbody]; }), pitch, 0.05 * pitch);
  EXPECT_GT(analysis.largest_stable_step_s, 1e-3);
}

TEST(SixAxleModes, ANestDampersRatioIsThatOfItsBounce) {
  const VehicleParams p = WithDampers();
  double ratio = 0.0, undamped = 0.0;
  for (const auto& mode : AnalyseModes(SixAxleVehicle(p)).modes) {
    if (mode.energy_share.z[kCarbody] > 0.8 && mode.frequency_hz < 3.0) ratio = mode.damping_ratio;
  }
  const double k = 8.0 * 1590e3, m = 120e3 + 2.0 * 1103.9;
  undamped = 8.0 * 2e4 / (2.0 * std::sqrt(k * m));
  // Pads and frames below make the suspension softer by 4 % and so the dampers' part smaller by some per cent.
  EXPECT_NEAR(ratio, undamped, 0.08 * undamped);
}

TEST(SixAxleStep, RestsWithoutMoving) {
  for (const VehicleParams& p : {WithWedges(), WithDampers()}) {
    RideOn<3> ride(p, {}, 0.0);
    const auto start = ride.state.position;
    ride.Run(5.0);
    EXPECT_LT(Difference(ride.state.position, start), 1e-12);
  }
}

TEST(SixAxleStep, BrakesLikeOneMassWithSixWheelsets) {
  RideOn<3> ride(WithoutResistance(WithDampers()), {}, 20.0);
  ride.loads.cylinder_pressure_pa = 100e3;
  ride.Run(3.0);  // the suspension has swung out
  const double before = ride.Speed(), shoes_before = ride.Shoes();
  ride.Run(1.0);
  const double mass = ride.wagon.params.TotalMass() + 6.0 * 679.0 / (0.485 * 0.485);
  const double shoes = 0.5 * (shoes_before + ride.Shoes());
  EXPECT_NEAR(before - ride.Speed(), shoes / mass, 1e-4 * shoes / mass);
  const double first = ride.output.shoe_force_n[0];
  for (const double shoe : ride.output.shoe_force_n) EXPECT_EQ(shoe, first);  // a sixth each
}

TEST(SixAxleEnergy, TheLedgerClosesToStandstill) {
  for (const VehicleParams& p : {WithWedges(), WithDampers()}) {
    TrackParams track;
    track.dips = {{60.0, 0.03, 10.0}};  // or the wedges would stick all the way
    RideOn<3> ride(p, track, 60.0 / 3.6);
    ride.loads_at = EmergencyLoads;
    ride.Run(80.0);
    EXPECT_LT(std::abs(ride.Speed()), 1e-3);
    EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
    EXPECT_EQ(ride.state.work.dissipated[kFrictionWedges] > 0.0, p.friction_wedge.has_value());
    EXPECT_EQ(ride.state.work.dissipated[kNestDampers] > 0.0, !p.friction_wedge.has_value());
  }
}

TEST(SixAxleSymmetry, RunningBackwardsIsTheMirrorImage) {
  VehicleParams p = WithDampers();
  p.middle_wheelset_offset_m = 0.2;
  EXPECT_LT(MirrorError<3>(p), 1e-9);  // rounding of 300 m over 50000 steps
}

LoadPlaces Loads(const std::vector<double>& coupler, const std::vector<double>& pressure) {
  LoadPlaces places;
  places.front_coupler_n = coupler.data();
  places.rear_coupler_n = coupler.data() + 1;
  places.cylinder_pressure_pa = pressure.data();
  return places;
}
ReplyPlaces Reply(std::vector<double>& x, std::vector<double>& v) {
  ReplyPlaces places;
  places.head_displacement_m = x.data();
  places.head_velocity_mps = v.data();
  return places;
}

class SixAxleKernels : public testing::TestWithParam<LaneKernels> {};

TEST_P(SixAxleKernels, MoveEachVehicleAsTheScalarStepDoes) {
  constexpr int kVehicles = 11;
  for (const VehicleParams& p : {WithWedges(), WithDampers()}) {
    const SixAxleVehicle vehicle(p);
    std::vector<WagonState<double, 3>> states;
    for (int i = 0; i < kVehicles; ++i) states.push_back(StaticEquilibrium(vehicle, -20.0 * i, 20.0 - i));
    VehicleBatch<SixAxleVehicle> batch(vehicle, GetParam(), states);
    std::vector<double> coupler(kVehicles + 1), pressure(kVehicles), x(kVehicles), v(kVehicles);
    for (int exchange = 0; exchange < 100; ++exchange) {
      for (int i = 0; i <= kVehicles; ++i) coupler[i] = 1e5 * std::sin(0.1 * exchange + i);
      for (int i = 0; i < kVehicles; ++i) pressure[i] = 4e3 * exchange + 1e3 * i;
      for (int i = 0; i < kVehicles; ++i) {
        VehicleLoads<double> loads;
        loads.front_coupler_n = coupler[i];
        loads.rear_coupler_n = coupler[i + 1];
        loads.cylinder_pressure_pa = pressure[i];
        for (int step = 0; step < 5; ++step) StepWagon<double, 3>(vehicle, {}, loads, 1e-3, states[i], nullptr);
      }
      ASSERT_TRUE(batch.Advance({}, 1e-3, 5, Loads(coupler, pressure), Reply(x, v), false));
    }
    std::vector<std::uint64_t> digests(kVehicles);
    batch.Digests(digests.data());
    for (int i = 0; i < kVehicles; ++i) {
      const WagonState<double, 3> s = batch.StateOf(i);
      EXPECT_EQ(states[i].position.pitch, s.position.pitch);
      EXPECT_EQ(states[i].velocity.x, s.velocity.x);
      EXPECT_EQ(states[i].work.dissipated, s.work.dissipated);
      Digest expected;  // positions, then velocities: x, z and pitch of each body
      for (const auto* motion : {&states[i].position, &states[i].velocity})
        for (int b = 0; b < kElevenBodies; ++b)
          for (const double number : {motion->x[b], motion->z[b], motion->pitch[b]}) expected.Add(number);
      EXPECT_EQ(digests[i], expected.value());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllInstructionSets, SixAxleKernels, testing::ValuesIn(AllLaneKernels()),
                         [](const auto& kernels) { return std::string(kernels.param.instruction_set); });

// ---- in a train ------------------------------------------------------------------------------------------------

// A six-axle vehicle in front of three wagons; what the scenario's file says besides.
std::string MixedTrain(const std::string& more) {
  return R"(base: single_wagon_stop
duration_s: 4
train:
  name: mixed
  connection: calibrated
  consist:
    - count: 1
      vehicle:
        base: ore_wagon
        name: six_axle
        length_m: 20
        half_bogie_spacing_m: 6
        wheelsets_per_bogie: 3
        half_wheelset_spacing_m: 1.85
        bogie_frame: {mass_kg: 8000, pitch_inertia_kgm2: 12000}
    - {vehicle: ore_wagon, count: 3}
)" + more;
}

class SixAxleTrain : public testing::Test {
 protected:
  void SetUp() override {
    setenv("TRAIN_BRAKE_CONFIG", TRAIN_BRAKE_CONFIG_DIR, 1);
    std::string pattern = (std::filesystem::temp_directory_path() / "six_axle_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  config::LoadedScenario Load(const std::string& text) const {
    const std::string file = folder_ / "mixed.yaml";
    std::ofstream(file) << text;
    return config::LoadScenario(file, {});
  }

  std::filesystem::path folder_;
};

TEST_F(SixAxleTrain, RunsWithWagonsAndGivesTheSameBitsInAnyNumberOfThreads) {
  const config::LoadedScenario loaded = Load(MixedTrain("detail_vehicles: [3]\n"));
  std::uint64_t one = 0;
  for (const int threads : {1, 3}) {
    InProcessTransport transport(loaded.params, loaded.consist, threads);
    TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
    double initial_j = 0.0, residual_j = 0.0, wheel_force_n = 0.0;
    master.AddObserver([&](const TrainRecord& record) {
      wheel_force_n = record.vehicles.wheel_force_n[0];
      if (!record.ledger) return;
      if (record.exchange == 0) initial_j = record.ledger->Stored();
      residual_j = record.ledger->Residual(initial_j);
    });
    master.Start();
    while (!master.Done()) master.Exchange();
    EXPECT_LT(std::abs(residual_j), 1e-6 * initial_j);
    EXPECT_GT(wheel_force_n, 1e3);  // two seconds of braking
    if (threads == 1) one = master.state_digest();
    EXPECT_EQ(master.state_digest(), one);
  }
}

TEST_F(SixAxleTrain, TakesAStateBackInBlocksOfAnyCut) {
  const config::LoadedScenario loaded = Load(MixedTrain("detail_vehicles: []\n"));
  constexpr int kVehicles = 4;
  ExchangeRequest request;
  request.dt_s = 1e-3;
  request.steps = 500;
  request.record = true;
  request.coupler_force_n = {0.0, 2e4, -3e4, 1e4, 0.0};
  request.cylinder_pressure_pa.assign(kVehicles, 200e3);
  const auto whole = MakeVehicleBlock(loaded.params, loaded.consist, 0, kVehicles);
  ExchangeReply reply(kVehicles, {});
  whole->Advance(request, 0, reply);
  std::vector<StateRow> state(kVehicles);
  whole->Save(state.data());
  EXPECT_GT(state[0].size(), state[1].size());  // two wheelsets more
  whole->Advance(request, 0, reply);
  ExchangeReply in_parts(kVehicles, {});
  for (const auto& [first, count] : {std::pair{0, 1}, {1, 2}, {3, 1}}) {
    const auto part = MakeVehicleBlock(loaded.params, loaded.consist, first, count);
    part->Restore(&state[first]);
    part->Advance(request, first, in_parts);
  }
  EXPECT_EQ(reply.state_digest, in_parts.state_digest);
}

TEST_F(SixAxleTrain, FullDetailOfASixAxleVehicleIsRefused) {
  try {
    Load(MixedTrain("detail_vehicles: [2, 1]\n"));
    FAIL() << "accepted";
  } catch (const strict_config::Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("mixed.yaml:17: detail_vehicles[1] must be a vehicle with wheelsets_per_bogie "
                        "2: full detail is not recorded of others"),
              std::string::npos)
        << error.what();
  }
}

TEST(SixAxleParameters, AVehicleOfAnotherNumberOfWheelsetsIsRefused) {
  EXPECT_THROW(Wagon{WithDampers()}, std::invalid_argument);
  EXPECT_THROW(SixAxleVehicle{OreWagon()}, std::invalid_argument);
  VehicleParams p = WithDampers();
  p.wheelsets_per_bogie = 4;
  EXPECT_THROW(SixAxleVehicle{p}, std::invalid_argument);
  p = WithDampers();
  p.middle_wheelset_offset_m = 1.85;
  EXPECT_THROW(SixAxleVehicle{p}, std::invalid_argument);
  p = OreWagon();
  p.middle_wheelset_offset_m = 0.1;
  EXPECT_THROW(Wagon{p}, std::invalid_argument);
  p = OreWagon();
  p.friction_wedge.reset();  // but wedge_mass_kg 6
  EXPECT_THROW(Wagon{p}, std::invalid_argument);
  p.wedge_mass_kg = 0.0;
  EXPECT_NO_THROW(Wagon{p});
}

}  // namespace
}  // namespace train_dynamics
