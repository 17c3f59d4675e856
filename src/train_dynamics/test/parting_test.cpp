// A connection that breaks: what it carries afterwards, where its energy goes, and what the brake does.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "simulate.h"
#include "train_dynamics/train/in_train_forces.h"

namespace train_dynamics {
namespace {

constexpr double kStrength = 9e5, kInterval = 1e-3;

/// Two heads on one connection, led along an extension; the work of its forces and its energy.
struct Pulled {
  explicit Pulled(ConnectionParams params) : forces(Two(std::move(params)), SlackState::kMiddle, 0.5 * kInterval) {
    forces.Begin({0.0, 0.0});
  }
  static Consist Two(ConnectionParams params) {
    params.strength_n = kStrength;
    TrainParams train;
    train.connection = std::move(params);
    train.consist.emplace_back();
    train.consist.back().vehicle = OreWagon();
    train.consist.back().count = 2;
    return Consist(train);
  }
  /// One interval at a rate of the extension; the force held over it.
  double Move(double rate_mps) {
    forces.Evaluate(time_s, {rate_mps, 0.0}, force_n);
    q += kInterval * rate_mps;
    forces.CloseInterval({q, 0.0});
    work_j += force_n[1] * kInterval * rate_mps;
    time_s += kInterval;
    return force_n[1];
  }
  double Booked() const {
    const ConnectionEnergy energy = forces.Energy();
    return energy.potential + energy.draft_gears + energy.draw_bars;
  }

  InTrainForces forces;
  std::vector<double> force_n;
  double q = 0.0, time_s = 0.0, work_j = 0.0;
};

TEST(Parting, CarriesNoTensionAfterwardsButPushes) {
  for (const char* name : {"draw_bar", "calibrated", "friction_gear", "ge_standard_pair", "mt2_and_polymer"}) {
    Pulled pulled(LoadPart<ConnectionParams>("couplers/" + std::string(name) + ".yaml"));
    double last_n = 0.0;
    while (pulled.forces.Partings().empty() && pulled.q < 0.5) last_n = pulled.Move(0.05);
    ASSERT_EQ(pulled.forces.Partings().size(), 1u) << name;
    EXPECT_EQ(pulled.forces.Partings()[0].connection, 0);
    EXPECT_NEAR(pulled.forces.Partings()[0].time_s, pulled.time_s, 1.5 * kInterval);
    EXPECT_EQ(last_n, 0.0);
    // The largest tension is the one at which it broke.
    EXPECT_GT(pulled.forces.Extremes()[0].tension_n, kStrength) << name;
    EXPECT_LT(pulled.forces.Extremes()[0].tension_n, 1.1 * kStrength) << name;
    // The stored energy is lost: all work done on the connection is dissipated. Laws whose spring is separate from the
    // friction do not book the change within one interval.
    EXPECT_NEAR(pulled.Booked(), pulled.work_j, 0.02 * pulled.work_j) << name;
    EXPECT_NEAR(pulled.forces.Energy().potential, 0.0, 1e-9) << name;
    for (int i = 0; i < 100; ++i) EXPECT_EQ(pulled.Move(0.05), 0.0) << name;
    while (pulled.q > 1e-3) EXPECT_EQ(pulled.Move(-0.05), 0.0) << name;
    while (pulled.q > -0.05) pulled.Move(-0.05);
    EXPECT_LT(pulled.Move(-0.05), -1e5) << name;
    while (pulled.q < 0.2) EXPECT_LE(pulled.Move(0.05), 0.0) << name;
    EXPECT_EQ(pulled.forces.Partings().size(), 1u) << name;
  }
}

// Full service brake of the paper's train whose couplers break at 80 kN; the brake is the service brake's until they
// do.
std::vector<std::string> Weak() {
  return {"model=ltd", "train.connection={base: friction_gear, strength_n: 8.0e4}", "duration_s=60"};
}

TEST(Parting, OpensTheBrakePipeAndBothPartsStopByAnEmergency) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("full_service"), Weak());
  InProcessTransport transport(loaded.params, loaded.consist, 1);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  std::vector<double> last_pressure_pa;
  master.AddObserver([&](const TrainRecord& record) {
    last_pressure_pa = record.cylinder_pressure_pa;
    for (const Parting& parting : master.in_train_forces().Partings()) {
      EXPECT_LE(record.held.coupler_force_n[parting.connection + 1], 0.0);
    }
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  const std::vector<Parting> partings = master.in_train_forces().Partings();
  ASSERT_FALSE(partings.empty());
  // Cylinders beside the first parting follow an emergency from there: Eq 2 with its rate at the source.
  const Parting first = partings[0];
  AirBrake expected(loaded.params.brake->empirical, TimedBrakeCommands(loaded.params.commands),
                    loaded.consist.centre_m);
  for (const Parting& parting : partings) expected.OpenPipe(parting.time_s, parting.connection);
  std::vector<double> law_pa;
  expected.PressuresAt(60.0, law_pa);
  for (std::size_t i = 0; i < law_pa.size(); ++i) EXPECT_NEAR(last_pressure_pa[i], law_pa[i], 1e-3) << i;
  AirBrake service(loaded.params.brake->empirical, TimedBrakeCommands(loaded.params.commands), loaded.consist.centre_m);
  std::vector<double> service_pa;
  service.PressuresAt(60.0, service_pa);
  EXPECT_GT(law_pa[first.connection], service_pa[first.connection] + 10e3);
  EXPECT_GT(law_pa[first.connection + 1], service_pa[first.connection + 1] + 10e3);
}

TEST(Parting, KeepsTheLedgerClosed) {
  const Outcome outcome = Simulate("full_service", Weak());
  EXPECT_LT(outcome.largest_residual_j, 1e-5 * outcome.initial_kinetic_j);
}

TEST(Parting, DoesNotHappenToConnectionsThatAreStrongEnough) {
  const std::vector<std::string> plain = {"model=ltd", "duration_s=30", "train.connection=friction_gear"};
  const std::vector<std::string> strong = {"model=ltd", "duration_s=30",
                                           "train.connection={base: friction_gear, strength_n: 1e7}"};
  const Outcome a = Simulate("emergency", plain), b = Simulate("emergency", strong);
  EXPECT_EQ(a.mean_speed_kmh, b.mean_speed_kmh);
  EXPECT_EQ(a.coupler_extremes[100].tension_n, b.coupler_extremes[100].tension_n);
}

}  // namespace
}  // namespace train_dynamics
