#include "train_dynamics/train/consist.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/train/in_train_forces.h"
#include "train_dynamics/train/scenario.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

ConnectionParams Gears() { return LoadPart<ConnectionParams>("couplers/calibrated.yaml"); }
ConnectionParams Bar() { return LoadPart<ConnectionParams>("couplers/draw_bar.yaml"); }

bool IsDrawBar(const Consist& consist, int connection) {
  return consist.connection_types[consist.connection_type[connection]].kind == ConnectionKind::kDrawBar;
}

TEST(Consist, ThePapersTrain) {
  const Consist consist(LoadPart<TrainParams>("trains/paper_242.yaml"));
  ASSERT_EQ(consist.vehicles(), 242);
  ASSERT_EQ(consist.connection_type.size(), 241u);
  int draw_bars = 0;
  for (int c = 1; c <= 241; ++c) {  // numbered as people do: connection c joins vehicles c and c + 1
    const bool expected = c <= 120 ? c % 2 == 0 : c >= 123 && c % 2 == 1;
    EXPECT_EQ(IsDrawBar(consist, c - 1), expected) << c;
    draw_bars += IsDrawBar(consist, c - 1);
  }
  EXPECT_EQ(draw_bars, 120);
  for (int i = 0; i < 242; ++i) EXPECT_EQ(consist.centre_m[i], -10.5 * i);
}

ConsistGroupParams Group(const VehicleParams& vehicle, int count, int vehicles_per_unit = 1,
                         const ConnectionParams& unit_connection = {}) {
  ConsistGroupParams group;
  group.vehicle = vehicle;
  group.count = count;
  group.vehicles_per_unit = vehicles_per_unit;
  group.unit_connection = unit_connection;
  return group;
}

TEST(Consist, LengthsAndUnits) {
  TrainParams train;
  train.connection = Gears();
  VehicleParams locomotive = OreWagon();
  locomotive.length_m = 20.5;
  train.consist = {Group(locomotive, 1), Group(OreWagon(), 6, 3, Bar())};
  const Consist consist(train);
  EXPECT_EQ(consist.centre_m, (std::vector<double>{0.0, -15.5, -26.0, -36.5, -47.0, -57.5, -68.0}));
  std::vector<bool> bars;
  for (int c = 0; c < 6; ++c) bars.push_back(IsDrawBar(consist, c));
  EXPECT_EQ(bars, (std::vector<bool>{false, true, true, false, true, true}));
  EXPECT_EQ(consist.vehicle(0).length_m, 20.5);
  EXPECT_EQ(consist.vehicle(6).length_m, 10.5);
  train.consist[1].count = 7;
  EXPECT_THROW(strict_config::Validate(train), std::invalid_argument);  // not whole units
  train.consist.clear();
  EXPECT_THROW(strict_config::Validate(train), std::invalid_argument);
}

TEST(VehicleIndex, CountsFromBothEnds) {
  EXPECT_EQ(VehicleIndex(1, 10), 0);
  EXPECT_EQ(VehicleIndex(10, 10), 9);
  EXPECT_EQ(VehicleIndex(-1, 10), 9);
  EXPECT_EQ(VehicleIndex(-10, 10), 0);
  for (const int none : {0, 11, -11}) EXPECT_EQ(VehicleIndex(none, 10), -1);
}

// ---- forces between vehicles
// ----------------------------------------------------------------------------------------

// Connections of n vehicles: draw-bars within pairs, gears between.
Consist Pairs(int pairs, const ConnectionParams& between = Gears(), const ConnectionParams& within = Bar()) {
  TrainParams train;
  train.connection = between;
  train.consist = {Group(OreWagon(), 2 * pairs, 2, within)};
  return Consist(train);
}

TEST(InTrainForces, StartWithoutForceInEveryStateOfSlack) {
  const Consist consist = Pairs(3);
  const std::vector<double> rest(6, 0.0);
  const double edge[] = {0.005, 0.0, -0.005};
  const SlackState states[] = {SlackState::kStretched, SlackState::kMiddle, SlackState::kBunched};
  for (int k = 0; k < 3; ++k) {
    InTrainForces forces(consist, states[k], 0.0);
    forces.Begin({0.1, 0.2, -0.1, 0.0, 0.3, 0.1});  // wherever the heads are, the slack starts as told
    std::vector<double> force;
    forces.Evaluate(0.0, rest, force);
    EXPECT_EQ(force, std::vector<double>(7, 0.0));
    std::vector<double> extension;
    forces.Extensions(extension);
    EXPECT_EQ(extension, (std::vector<double>{0.0, edge[k], 0.0, edge[k], 0.0}));
    EXPECT_EQ(forces.Energy().potential, 0.0);
  }
}

TEST(InTrainForces, AreTheLawsAtThePredictedExtension) {
  const Consist consist = Pairs(2);
  constexpr double kAhead = 5e-4;
  InTrainForces forces(consist, SlackState::kMiddle, kAhead);
  forces.Begin({0.0, 0.0, 0.0, 0.0});
  std::vector<double> force;
  forces.Evaluate(0.0, {0.0, 0.0, 0.0, 0.0}, force);
  forces.CloseInterval({0.05, 0.04, 0.0, 0.002});
  forces.Evaluate(1.0, {0.3, 0.1, 0.4, 0.4}, force);
  ASSERT_EQ(force.size(), 5u);
  EXPECT_EQ(force.front(), 0.0);
  EXPECT_EQ(force.back(), 0.0);
  const DraftGear gear(Gears().draft_gear);
  const auto bar = [](double q, double rate) { return 1.5e8 * q + 1.0e6 * rate; };
  EXPECT_NEAR(force[1], bar(0.01 + kAhead * 0.2, 0.2), 1e-6);  // rounding of 1.5e8 N/m x 0.05 m
  EXPECT_NEAR(force[2], SmoothGearForce(gear, 0.04 - kAhead * 0.3, -0.3).force, 1e-6);
  EXPECT_NEAR(force[3], bar(-0.002, 0.0), 1e-6);
  // Extremes: what has been, with its time.
  EXPECT_EQ(forces.Extremes()[0].tension_n, force[1]);
  EXPECT_EQ(forces.Extremes()[0].tension_time_s, 1.0);
  EXPECT_EQ(forces.Extremes()[2].compression_n, force[3]);
  EXPECT_EQ(forces.Extremes()[2].tension_n, 0.0);
}

// Free vehicles on level track without resistance, joined and let go.
class FreeTrain {
 public:
  FreeTrain(const Consist& consist, const std::vector<double>& speeds, double dt, double prediction,
            SlackState slack = SlackState::kMiddle)
      : vehicle_(Plain(), true), forces_(consist, slack, prediction), dt_(dt), speed_(speeds), states_(speeds.size()) {
    for (size_t i = 0; i < speeds.size(); ++i) states_[i].v_mps = speeds[i];
    forces_.Begin(Displacements());
  }

  void Step() {
    for (size_t i = 0; i < states_.size(); ++i) speed_[i] = states_[i].v_mps;
    forces_.Evaluate(0.0, speed_, force_);
    for (size_t i = 0; i < states_.size(); ++i) {
      VehicleLoads<double> loads;
      loads.front_coupler_n = force_[i];
      loads.rear_coupler_n = force_[i + 1];
      StepLtd(vehicle_, {}, loads, dt_, states_[i]);
    }
    forces_.CloseInterval(Displacements());
  }

  double Momentum() const {
    double sum = 0.0;
    for (const auto& s : states_) sum += vehicle_.inertia_kg * s.v_mps;
    return sum;
  }
  double Kinetic() const {
    double sum = 0.0;
    for (const auto& s : states_) sum += KineticEnergy(vehicle_, s);
    return sum;
  }
  const std::vector<double>& force() const { return force_; }
  const InTrainForces& forces() const { return forces_; }

 private:
  static VehicleParams Plain() {
    VehicleParams p = OreWagon();
    p.propulsion_resistance = {0.0, 0.0, 0.0};
    return p;
  }
  std::vector<double> Displacements() const {
    std::vector<double> x;
    for (const auto& s : states_) x.push_back(s.x_m);
    return x;
  }

  LtdVehicle vehicle_;
  InTrainForces forces_;
  double dt_;
  std::vector<double> speed_, force_;
  std::vector<LtdState<double>> states_;
};

std::vector<double> RandomSpeeds(int n) {
  std::mt19937_64 random(5);
  std::vector<double> v(n);
  for (double& one : v) one = 10.0 + std::uniform_real_distribution<>(-0.4, 0.4)(random);
  return v;
}

TEST(InTrainForces, KeepMomentumAndTakeEnergy) {
  constexpr double kDt = 1e-3;
  for (const DraftGearFriction friction : {DraftGearFriction::kSmooth, DraftGearFriction::kStickSpring}) {
    ConnectionParams gears = Gears();
    gears.draft_gear.friction = friction;
    FreeTrain train(Pairs(8, gears), RandomSpeeds(16), kDt, 0.5 * kDt);
    const double momentum = train.Momentum(), kinetic = train.Kinetic();
    const double relative = kinetic - 0.5 * momentum * momentum / (16.0 * LtdVehicle(OreWagon(), true).inertia_kg);
    for (int i = 0; i < 20000; ++i) train.Step();
    EXPECT_NEAR(train.Momentum(), momentum, 1e-12 * momentum);  // rounding of 20000 steps
    const ConnectionEnergy energy = train.forces().Energy();
    EXPECT_GT(energy.draft_gears, 0.0);
    EXPECT_GT(energy.draw_bars, 0.0);
    EXPECT_GE(energy.potential, 0.0);
    // The books miss what a leapfrog step swings by, (omega dt / 2)^2 = 4e-4 of the relative motion's energy.
    const double stored = train.Kinetic() + energy.potential;
    EXPECT_NEAR(stored + energy.draft_gears + energy.draw_bars, kinetic, 1e-3 * relative);
    EXPECT_LT(stored, kinetic - 0.9 * relative);  // the train has come to move as one
  }
}

TEST(InTrainForces, AreTheSameSeenFromTheOtherEnd) {
  constexpr double kDt = 1e-3;
  const std::vector<double> speeds = RandomSpeeds(12);
  std::vector<double> reversed;
  for (auto v = speeds.rbegin(); v != speeds.rend(); ++v) reversed.push_back(-*v);
  FreeTrain forward(Pairs(6), speeds, kDt, 0.5 * kDt), backward(Pairs(6), reversed, kDt, 0.5 * kDt);
  for (int i = 0; i < 5000; ++i) {
    forward.Step();
    backward.Step();
    for (size_t c = 0; c < 13; ++c) {
      // Tension stays tension. Extensions are the same differences of positions up to their order of
      // subtraction: rounding of 60 m, times a stiffness of 1.5e8 N/m.
      ASSERT_NEAR(forward.force()[c], backward.force()[12 - c], 1e-3) << i;
    }
  }
}

// Energy of two vehicles on an undamped draw-bar after one second, relative to the start.
double DrawBarEnergy(double prediction_in_intervals) {
  constexpr double kDt = 1e-3;
  ConnectionParams bar = Bar();
  bar.draw_bar.damping_ns_per_m = 0.0;
  FreeTrain train(Pairs(1, Gears(), bar), {0.1, -0.1}, kDt, prediction_in_intervals * kDt);
  const double initial = train.Kinetic();
  double last_swing = 0.0;  // largest energy of the last 50 ms, more than one period
  for (int i = 0; i < 1000; ++i) {
    train.Step();
    if (i >= 950) last_swing = std::max(last_swing, train.Kinetic() + train.forces().Energy().potential);
  }
  return last_swing / initial;
}

TEST(InTrainForces, ForcesOfTheIntervalsMiddleKeepTheEnergyOfADrawBar) {
  const double omega_squared = 2.0 * 1.5e8 / LtdVehicle(OreWagon(), true).inertia_kg;
  // A leapfrog swings by (omega dt / 2)^2 = 4e-4 about the true energy and keeps that for ever.
  EXPECT_NEAR(DrawBarEnergy(0.5), 1.0, 1e-3);
  // With the force of the interval's start the damping ratio is -omega H / 4: energy grows by exp(omega^2 H t
  // / 2).
  EXPECT_NEAR(DrawBarEnergy(0.0), std::exp(0.5 * omega_squared * 1e-3), 0.01 * std::exp(0.5 * omega_squared * 1e-3));
}

}  // namespace
}  // namespace train_dynamics
