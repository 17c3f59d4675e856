// What the torques on the wheelsets react on, and shoes whose friction follows the tread.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "ride.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics {
namespace {

VehicleParams With(BrakeReaction reaction, FrictionSpeed speed = FrictionSpeed::kVehicle,
                   VehicleParams p = OreWagon()) {
  p.brake_rigging.reaction = reaction;
  p.brake_rigging.friction_speed = speed;
  return p;
}

VehicleParams WithoutRollingResistance(VehicleParams p) {
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  return p;
}

constexpr std::array<BrakeReaction, 3> kReactions = {BrakeReaction::kFrame, BrakeReaction::kCarbody,
                                                     BrakeReaction::kNone};

// Means over a second of steady motion.
struct SteadyMotion {
  double deceleration = 0.0;                // [m/s^2]
  std::array<double, kWheelsets> normal{};  // [N]
  std::array<double, kWheelsets> shoe{};    // [N]
  double speed = 0.0;                       // [m/s]
  double Moment(const Wagon& w) const {     // sum x_i N_i
    double sum = 0.0;
    for (int i = 0; i < kWheelsets; ++i) sum += w.wheelset_offset_m[i] * normal[i];
    return sum;
  }
};

SteadyMotion Measure(Ride& ride) {
  SteadyMotion mean;
  constexpr int kSteps = 1000;
  const double before = ride.Speed();
  for (int step = 0; step < kSteps; ++step) {
    ride.Step(kStep);
    for (int i = 0; i < kWheelsets; ++i) {
      mean.normal[i] += ride.output.normal_force_n[i] / kSteps;
      mean.shoe[i] += ride.output.shoe_force_n[i] / kSteps;
    }
    mean.speed += ride.Speed() / kSteps;
  }
  mean.deceleration = before - ride.Speed();
  return mean;
}

// sum m h + 4 J / r, from the paper's numbers.
double MomentPerDeceleration() {
  return 147599.8 * 2.0 + 2.0 * 1127.9 * 0.55 + 2.0 * 1665.5 * 0.485 + 4.0 * 1731.8 * 0.485 + 4.0 * 679.0 / 0.485;
}

TEST(BrakeReaction, AxleLoadsBalanceTheAngularMomentumAboutTheRail) {
  // sum x_i N_i = a (sum m h + 4 J / r) - D h_c + X h_coupler, whatever the shoes hang on in the vehicle.
  struct Load {
    double pressure_pa, rear_coupler_n, traction_n, dynamic_brake_n;
  };
  for (const BrakeReaction reaction : {BrakeReaction::kFrame, BrakeReaction::kCarbody}) {
    for (const Load& load : {Load{300e3, 0.0, 0.0, 0.0}, Load{150e3, 2e5, 0.0, 0.0}, Load{0.0, 0.0, 8e4, 0.0},
                             Load{0.0, -1e5, 0.0, 6e4}}) {
      Ride ride(With(reaction, FrictionSpeed::kTread), {}, 22.0);
      ride.loads.cylinder_pressure_pa = load.pressure_pa;
      ride.loads.rear_coupler_n = load.rear_coupler_n;
      ride.loads.traction_n = load.traction_n;
      ride.loads.dynamic_brake_n = load.dynamic_brake_n;
      ride.Run(8.0);  // the springs have swung out
      const SteadyMotion m = Measure(ride);
      const double v_kmh = 3.6 * m.speed;
      const double drag = 1e-3 * ride.wagon.weight_n * 0.000125 * v_kmh * v_kmh;
      const double push = -load.rear_coupler_n;  // forward
      const double expected = m.deceleration * MomentPerDeceleration() - drag * 2.0 + push * 0.85;
      EXPECT_NEAR(m.Moment(ride.wagon), expected, 1e-4 * std::abs(expected));
    }
  }
}

// An emergency until the speed has fallen to 41.5 km/h: the moment, and what each wheelset has over a quarter of the
// weight.
std::array<double, 5> AtFortyOne(BrakeReaction reaction) {
  Ride ride(With(reaction), {}, 80.0 / 3.6);
  ride.loads_at = EmergencyLoads;
  while (ride.Speed() > 41.5 / 3.6) ride.Step(kStep);
  std::array<double, 5> result{};
  for (int i = 0; i < kWheelsets; ++i) {
    result[0] += ride.wagon.wheelset_offset_m[i] * ride.output.normal_force_n[i];
    result[1 + i] = ride.output.normal_force_n[i] - 0.25 * ride.wagon.weight_n;
  }
  return result;
}

TEST(BrakeReaction, NumbersOfAnIndependentProgram) {
  // Half a unit of the last digit given; the moment is that of one instant of a wagon that still swings a little.
  const auto frame = AtFortyOne(BrakeReaction::kFrame), none = AtFortyOne(BrakeReaction::kNone);
  EXPECT_NEAR(1e-3 * frame[0], 96.78, 0.05);
  EXPECT_NEAR(1e-3 * none[0], 70.5, 0.05);
  const double with_reaction[] = {12.9, -3.7, 3.7, -12.9}, without[] = {6.8, 1.9, -1.9, -6.8};
  for (int i = 0; i < kWheelsets; ++i) {
    EXPECT_NEAR(1e-3 * frame[1 + i], with_reaction[i], 0.06) << "wheelset " << i + 1;
    EXPECT_NEAR(1e-3 * none[1 + i], without[i], 0.06) << "wheelset " << i + 1;
  }
}

TEST(BrakeReaction, WithinABogieTheFrameIsInBalance) {
  // Moments on a frame about its CG: pads (N less the wheelset's weight, at +- l_w), nests and wedges, the
  // bolster's guide, and the torques of its two wheelsets.
  for (const BrakeReaction reaction : kReactions) {
    Ride ride(With(reaction), {}, 22.0);
    ride.loads.cylinder_pressure_pa = 350e3;
    ride.Run(10.0);
    const SteadyMotion m = Measure(ride);
    const Wagon& w = ride.wagon;
    const double v_kmh = 3.6 * ride.Speed();
    const double rolling = 0.25e-3 * w.weight_n * (0.92 + 0.0048 * v_kmh);
    const ElementVector<double> e = ElasticForces(w, ElementsOf(w, ride.state.position));
    for (int bogie = 0; bogie < kBogies; ++bogie) {
      double suspension = w.guide_frame_arm_m * e.guide_x[bogie];
      for (int end = 0; end < 2; ++end) {
        const int i = 2 * bogie + end;
        const double sign = end == 0 ? 1.0 : -1.0;
        suspension += sign * (0.15 * e.nest[i] + 0.25 * (e.wedge[i] + ride.output.wedge_friction_n[i]));
      }
      double torque = 0.0;
      for (int i = 2 * bogie; i < 2 * bogie + 2; ++i) {
        if (reaction != BrakeReaction::kNone) torque += 0.485 * rolling;
        if (reaction == BrakeReaction::kFrame) torque += 0.485 * m.shoe[i];
      }
      const double pads = 0.975 * (m.normal[2 * bogie] - m.normal[2 * bogie + 1]);
      EXPECT_NEAR(pads, torque + suspension, 10.0) << "bogie " << bogie;  // of 17 kNm; shoe forces drift in 1 s
      EXPECT_GT(std::abs(suspension), 100.0);
    }
  }
}

TEST(BrakeReaction, ShoesOnTheCarbodyLeaveTheBogiesAlone) {
  std::array<SteadyMotion, 3> m;
  for (int k = 0; k < 3; ++k) {
    Ride ride(WithoutRollingResistance(With(kReactions[k])), {}, 22.0);
    ride.loads.cylinder_pressure_pa = 350e3;
    ride.Run(10.0);
    m[k] = Measure(ride);
  }
  const auto within = [&](int k) { return m[k].normal[0] - m[k].normal[1]; };
  const auto between = [&](int k) { return m[k].normal[0] + m[k].normal[1] - m[k].normal[2] - m[k].normal[3]; };
  const double s = m[0].shoe[0];
  // The reaction loads one wheelset of each bogie by r S / l_w and unloads the other one, less about ten per cent.
  EXPECT_NEAR(within(0) - within(2), 2.0 * 0.485 * s / 0.975, 0.2 * s);
  EXPECT_LT(within(0) - within(2), 2.0 * 0.485 * s / 0.975);
  EXPECT_LT(std::abs(within(1) - within(2)), 0.1 * s);
  // The carbody's torque 4 r S goes to the bogies' distance.
  EXPECT_NEAR(between(1) - between(2), 4.0 * 0.485 * s / 3.4825, 0.01 * s);
}

TEST(BrakeReaction, TheLedgerClosesAndForwardsIsTheMirrorOfBackwards) {
  for (const BrakeReaction reaction : kReactions) {
    for (const FrictionSpeed speed : {FrictionSpeed::kTread, FrictionSpeed::kVehicle}) {
      VehicleParams p = With(reaction, speed);
      p.friction_wedge->static_friction_coefficient = 0.0;
      p.friction_wedge->kinetic_friction_coefficient = 0.0;
      EXPECT_LT(MirrorError(p), 1e-9);  // rounding; MirrorError looks at the ledgers, too
    }
  }
}

TEST(BrakeReaction, TheLedgerClosesOverLockedWheelsAndStandstill) {
  for (const BrakeReaction reaction : kReactions) {
    for (const double inertia : {120.0, 679.0}) {
      VehicleParams p = With(reaction, FrictionSpeed::kTread);
      p.wheelset.pitch_inertia_kgm2 = inertia;
      p.wheel_rail.adhesion = {0.06, 0.4, 0.2, 0.3, 0.1};
      Ride ride(p, {}, 12.0);
      ride.loads.cylinder_pressure_pa = kFullPressure * 2.5;
      ride.Run(60.0);
      EXPECT_LT(std::abs(ride.Speed()), 1e-3);
      EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
      EXPECT_GT(ride.state.work.dissipated[kBrakeShoes], 0.0);
      // Most of the energy went into the rails: the wheels slid.
      EXPECT_GT(ride.state.work.dissipated[kWheelRailCreep], 0.5 * ride.initial_energy - 2e6);
      const BodyVector<double> stopped = ride.state.position;
      ride.Run(10.0);
      EXPECT_LT(Difference(ride.state.position, stopped), 1e-4);  // stands, and does not shake
    }
  }
}

// ---- friction over the speed of the tread ------------------------------------------------------------------

// Whether wheels that are locked at 60 km/h are so after half a second, with this friction on the rail.
bool StaysLocked(FrictionSpeed speed, double adhesion) {
  VehicleParams p = With(BrakeReaction::kNone, speed);
  p.wheel_rail.adhesion = {adhesion, 1.0, 0.0, 1.0, 1.0};
  Ride ride(p, {}, 60.0 / 3.6);
  for (int i = kWheelset1; i < kBodies; ++i) ride.state.velocity.pitch[i] = 0.0;
  ride.loads.cylinder_pressure_pa = 430e3;
  ride.Run(0.5);
  int locked = 0;
  for (int i = kWheelset1; i < kBodies; ++i) locked += ride.state.velocity.pitch[i] == 0.0;
  EXPECT_TRUE(locked == 0 || locked == kWheelsets);
  return locked == kWheelsets;
}

TEST(TreadFriction, ALockedWheelIsHeldByTheFrictionOfStandstill) {
  // Shoes per weight: C p / W. At 60 km/h mu_b is 0.322 210 / 270 = 0.2504, at standstill 0.322.
  const double load = 0.46035 * 430e3 / (9.81 * 160113.8);
  const double rolling_at_60 = 1e-3 * (0.92 + 0.0048 * 60.0);
  const double moving = load * 0.2504 + rolling_at_60, standing = load * 0.322 + rolling_at_60;
  for (const double adhesion : {0.5 * moving, 0.98 * moving}) {
    EXPECT_TRUE(StaysLocked(FrictionSpeed::kVehicle, adhesion));
    EXPECT_TRUE(StaysLocked(FrictionSpeed::kTread, adhesion));
  }
  for (const double adhesion : {1.03 * moving, 0.97 * standing}) {  // S(v) < mu N < S(0)
    EXPECT_FALSE(StaysLocked(FrictionSpeed::kVehicle, adhesion));
    EXPECT_TRUE(StaysLocked(FrictionSpeed::kTread, adhesion));
  }
  for (const double adhesion : {1.04 * standing, 1.5 * standing}) {
    EXPECT_FALSE(StaysLocked(FrictionSpeed::kVehicle, adhesion));
    EXPECT_FALSE(StaysLocked(FrictionSpeed::kTread, adhesion));
  }
}

TEST(TreadFriction, IsThatOfTheVehicleWhereWheelsRoll) {
  // 1 % of creepage is 1 % of the speed: 0.3 % of the friction at most.
  std::array<double, 2> distance{};
  for (int k = 0; k < 2; ++k) {
    Ride ride(With(BrakeReaction::kNone, k == 0 ? FrictionSpeed::kTread : FrictionSpeed::kVehicle), {}, 20.0);
    ride.loads.cylinder_pressure_pa = 400e3;
    ride.Run(20.0);
    distance[k] = ride.Distance();
  }
  EXPECT_NEAR(distance[0], distance[1], 1e-4 * distance[1]);
  EXPECT_NE(distance[0], distance[1]);
}

// ---- the wagons that exist ---------------------------------------------------------------------------------

TEST(OreWagons, TheEmptyOneRestsOnItsSpringsAndAsksForMuchAdhesion) {
  const VehicleParams p = LoadPart<VehicleParams>("vehicles/ore_wagon_empty.yaml");
  EXPECT_NEAR(p.TotalMass(), 28500.0, 0.5);
  const Wagon w(p);
  const ElementVector<double> e = ElementsOf(w, StaticEquilibrium(w, 0.0, 0.0).position);
  // By hand: carbody and bolsters on eight quarters of 1590 kN/m and, with kappa^2, 983 kN/m.
  const double kappa = 0.9505;
  const double rest = 9.81 * (15986.0 + 2.0 * 1127.9) / (8.0 * (1590e3 + kappa * kappa * 983e3));
  for (const double nest : e.nest) EXPECT_NEAR(nest, rest, 1e-6);
  EXPECT_LT(rest, 0.022);  // on the outer springs alone
  const auto adhesion = [&](double kmh) { return ShoeForce(p.Rigging(), kFullPressure, kmh / 3.6) / p.Weight(); };
  EXPECT_NEAR(100.0 * adhesion(80.0), 16.9, 0.05);
  EXPECT_NEAR(100.0 * adhesion(0.0), 22.8, 0.05);
}

TEST(OreWagons, TheLoadedOneIsThePapersWithARealWheelset) {
  const VehicleParams p = LoadPart<VehicleParams>("vehicles/ore_wagon_loaded.yaml");
  EXPECT_EQ(p.TotalMass(), OreWagon().TotalMass());
  EXPECT_EQ(p.wheelset.pitch_inertia_kgm2, 120.0);
  EXPECT_EQ(p.brake_rigging.reaction, BrakeReaction::kFrame);
  EXPECT_EQ(p.brake_rigging.friction_speed, FrictionSpeed::kTread);
  EXPECT_EQ(OreWagon().brake_rigging.reaction, BrakeReaction::kNone);  // [P]
  EXPECT_EQ(OreWagon().brake_rigging.friction_speed, FrictionSpeed::kVehicle);
}

// ---- on every instruction set ----------------------------------------------------------------------------------

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

class ReactionKernels : public testing::TestWithParam<LaneKernels> {};

TEST_P(ReactionKernels, SlideAsTheScalarStepDoes) {
  constexpr int kVehicles = 9;
  for (const BrakeReaction reaction : kReactions) {
    VehicleParams p = With(reaction, FrictionSpeed::kTread);
    p.wheelset.pitch_inertia_kgm2 = 120.0;
    p.wheel_rail.adhesion = {0.05, 0.4, 0.2, 0.3, 0.1};
    const Wagon wagon(p);
    std::vector<WagonState<double>> states;
    for (int i = 0; i < kVehicles; ++i) states.push_back(StaticEquilibrium(wagon, -12.0 * i, 15.0 - i));
    WagonBatch batch(wagon, GetParam(), states);
    std::vector<double> coupler(kVehicles + 1), pressure(kVehicles), x(kVehicles), v(kVehicles);
    for (int i = 0; i < kVehicles; ++i) pressure[i] = 150e3 * i;
    for (int exchange = 0; exchange < 800; ++exchange) {
      for (int i = 0; i < kVehicles; ++i) {
        VehicleLoads<double> loads;
        loads.cylinder_pressure_pa = pressure[i];
        for (int step = 0; step < 5; ++step) StepWagon<double, 2>(wagon, {}, loads, 1e-3, states[i], nullptr);
      }
      ASSERT_TRUE(batch.Advance({}, 1e-3, 5, Loads(coupler, pressure), Reply(x, v), false));
    }
    int locked = 0;
    for (int i = 0; i < kVehicles; ++i) {
      const WagonState<double> s = batch.StateOf(i);
      EXPECT_EQ(states[i].position.pitch, s.position.pitch);
      EXPECT_EQ(states[i].velocity.x, s.velocity.x);
      EXPECT_EQ(states[i].velocity.pitch, s.velocity.pitch);
      EXPECT_EQ(states[i].work.dissipated, s.work.dissipated);
      locked += s.velocity.pitch[kWheelset4] == 0.0;
    }
    EXPECT_GT(locked, 2);
    EXPECT_LT(locked, kVehicles);
  }
}

INSTANTIATE_TEST_SUITE_P(AllInstructionSets, ReactionKernels, testing::ValuesIn(AllLaneKernels()),
                         [](const auto& kernels) { return std::string(kernels.param.instruction_set); });

// ---- slides ----------------------------------------------------------------------------------------------------

struct Slides {
  std::array<double, kWheelsets> first_s, locked_s{}, locked_m{};
};

// A wagon stops from 80 km/h under an emergency at 2 s, as in single_wagon_stop. First above 20 % creepage;
// locked: the tread slower than 2 % of the wheelset.
// @param least_speed  below which time and distance are not counted [m/s]
Slides Stop(const VehicleParams& params, const TrackParams& track, double least_speed = 1e-3) {
  Ride ride(params, track, 80.0 / 3.6);
  ride.loads_at = [](double t) { return EmergencyLoads(std::max(0.0, t - 2.0)); };
  Slides slides;
  slides.first_s.fill(-1.0);
  while (ride.time_s < 120.0 && ride.Speed() > least_speed) {
    ride.Step(kStep);
    for (int i = 0; i < kWheelsets; ++i) {
      if (ride.output.creepage[i] > 0.2 && slides.first_s[i] < 0.0 && ride.Speed() > 3.0 / 3.6) {
        slides.first_s[i] = ride.time_s;
      }
      if (0.485 * std::abs(ride.state.velocity.pitch[kWheelset1 + i]) > 0.02 * ride.Speed()) continue;
      slides.locked_s[i] += kStep;
      slides.locked_m[i] += kStep * ride.Speed();
    }
  }
  EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
  return slides;
}

VehicleParams Slippery(BrakeReaction reaction, FrictionSpeed speed, double load, double inertia = 679.0) {
  VehicleParams p = With(reaction, speed);
  p.brake_rigging.shoe_load_per_pressure_n_per_pa = load;
  p.wheelset.pitch_inertia_kgm2 = inertia;
  return p;
}

TrackParams Patches(std::vector<FrictionPatchParams> patches) {
  TrackParams track;
  track.friction_patches = std::move(patches);
  return track;
}

void ExpectSlides(const Slides& slides, const std::array<double, kWheelsets>& first_s,
                  const std::array<double, kWheelsets>& locked_m) {
  for (int i = 0; i < kWheelsets; ++i) {
    // One unit of the last digit given; for distances two, which is what a threshold of lock of 1 % or 5 % moves.
    EXPECT_NEAR(slides.first_s[i], first_s[i], 0.1) << "wheelset " << i + 1;
    EXPECT_NEAR(slides.locked_m[i], locked_m[i], 0.2) << "wheelset " << i + 1;
  }
}

TEST(LockOrder, TheShoesReactionLocksTheFourthThenTheSecondThenTheThirdNeverTheFirst) {
  // First above 20 % creepage [s] and distances locked [m] of an independent program; -1: never.
  const TrackParams track = Patches({{-1e3, 1e5, 0.1}});
  ExpectSlides(Stop(Slippery(BrakeReaction::kFrame, FrictionSpeed::kTread, 1.3), track), {-1.0, 28.0, 30.1, 24.6},
               {0.0, 2.1, 0.1, 10.6});
  ExpectSlides(Stop(Slippery(BrakeReaction::kFrame, FrictionSpeed::kVehicle, 1.3), track), {-1.0, 28.2, 30.2, 25.0},
               {0.0, 1.5, 0.1, 7.3});
  const Slides without = Stop(Slippery(BrakeReaction::kNone, FrictionSpeed::kVehicle, 1.3), track);
  const double none_m[] = {0.0, 0.2, 0.8, 2.6};
  for (int i = 0; i < kWheelsets; ++i) EXPECT_NEAR(without.locked_m[i], none_m[i], 0.2);
  EXPECT_LT(without.first_s[3], without.first_s[2]);  // 4, 3, 2
  EXPECT_LT(without.first_s[2], without.first_s[1]);
  const Slides light = Stop(Slippery(BrakeReaction::kFrame, FrictionSpeed::kTread, 1.3, 120.0), track);
  const double light_m[] = {0.3, 21.7, 7.4, 54.3};
  for (int i = 0; i < kWheelsets; ++i) EXPECT_NEAR(light.locked_m[i], light_m[i], 0.2);
}

TEST(LockOrder, FollowsTheLoadsOfTheAxles) {
  // Another load, surface and inertia: whatever they are, the wheelset with the least load slides first.
  const TrackParams track = Patches({{-1e3, 1e5, 0.08}});
  const Slides slides = Stop(Slippery(BrakeReaction::kFrame, FrictionSpeed::kTread, 1.15, 200.0), track);
  EXPECT_GT(slides.first_s[3], 2.0);
  EXPECT_LT(slides.first_s[3], slides.first_s[1]);
  EXPECT_LT(slides.first_s[1], slides.first_s[2]);
  EXPECT_GT(slides.locked_m[3], slides.locked_m[1]);
  EXPECT_GT(slides.locked_m[1], slides.locked_m[2]);
}

TEST(Readhesion, WheelsThatStandStayLockedWhereTheirShoesHoldThem) {
  // Times [s] of an independent program. It does not say to what speed it counts; from 0.4 m/s on all six agree.
  const TrackParams leaves = Patches({{300.0, 360.0, 0.01}, {360.0, 1e5, 0.05}});
  constexpr double kLeast = 0.4;
  const auto times = [&](BrakeReaction reaction, FrictionSpeed speed, double least) {
    return Stop(Slippery(reaction, speed, 0.62), leaves, least).locked_s;
  };
  const auto both = times(BrakeReaction::kFrame, FrictionSpeed::kTread, kLeast);
  const auto tread = times(BrakeReaction::kNone, FrictionSpeed::kTread, kLeast);
  const double both_s[] = {0.0, 29.9, 23.1, 33.0}, tread_s[] = {0.0, 24.5, 28.9, 31.0};
  for (int i = 0; i < kWheelsets; ++i) {
    EXPECT_NEAR(both[i], both_s[i], 0.03 * both_s[i] + 0.01) << "wheelset " << i + 1;
    EXPECT_NEAR(tread[i], tread_s[i], 0.03 * tread_s[i] + 0.01) << "wheelset " << i + 1;
  }
  // With the friction at the vehicle's speed the wheels turn again: none is locked above 3 km/h.
  for (const double locked : times(BrakeReaction::kNone, FrictionSpeed::kVehicle, 3.0 / 3.6)) {
    EXPECT_EQ(locked, 0.0);
  }
}

}  // namespace
}  // namespace train_dynamics
