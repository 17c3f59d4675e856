// The locomotives' own brakes: independent brake, bail-off, blending with the dynamic brake.

#include "train_dynamics/brake/locomotive_brakes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulate.h"
#include "strict_config/error_list.h"
#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"

namespace train_dynamics {
namespace {

LocomotiveBrakeCommand Independent(double time_s, double kpa, std::vector<int> vehicles = {}) {
  return {time_s, LocomotiveBrakeCommandKind::kIndependent, kpa, std::move(vehicles)};
}

// 100 kPa/s up and 80 kPa/s down, from wherever it is; the greater of the two brakes acts.
TEST(IndependentBrake, GoesToItsPressureAtItsRate) {
  LocomotiveBrakes brakes({}, {{0, 0.0}, {3, 2.0}}, 5);
  brakes.Command(Independent(1.0, 300.0));
  brakes.Command(Independent(3.0, 0.0, {1}));
  const auto at = [&](double t, double automatic_pa) {
    std::vector<double> pressure_pa(5, automatic_pa);
    brakes.Act(t, pressure_pa);
    return pressure_pa;
  };
  EXPECT_EQ(at(0.5, 0.0), (std::vector<double>{0, 0, 0, 0, 0}));
  EXPECT_NEAR(at(2.5, 0.0)[0], 150e3, 1e-6);
  EXPECT_NEAR(at(4.0, 0.0)[0], 200e3 - 80e3, 1e-6);  // it had 200 kPa when it was let go
  EXPECT_NEAR(at(4.0, 0.0)[3], 100e3, 1e-6);         // the radio's 2 s later
  const std::vector<double> end = at(20.0, 40e3);
  EXPECT_EQ(end, (std::vector<double>{40e3, 40e3, 40e3, 300e3, 40e3}));
}

// With k = 1 / (1000 C mu) the locomotive brakes by the stronger of air and dynamic brake: their sum is that.
TEST(Blending, KeepsTheStrongerOfTheTwoBrakes) {
  LocomotiveBrakeParams params;
  const double c_mu = 0.46 * 0.25;  // N/Pa at the tread
  params.blending_kpa_per_kn = 1.0 / c_mu;
  LocomotiveBrakes brakes(params, {{1, 0.0}}, 2);
  for (double dynamic_n : {0.0, 10e3, 30e3, 200e3}) {
    std::vector<double> pressure_pa(2, 250e3);
    brakes.SetDynamicBrake(0, dynamic_n);
    brakes.Act(1.0, pressure_pa);
    EXPECT_NEAR(c_mu * pressure_pa[1] + dynamic_n, std::max(c_mu * 250e3, dynamic_n), 1e-6);
    EXPECT_EQ(pressure_pa[0], 250e3);  // no locomotive
  }
  // What the driver sets by hand stays.
  brakes.Command(Independent(1.0, 200.0));
  std::vector<double> pressure_pa(2, 250e3);
  brakes.Act(60.0, pressure_pa);
  EXPECT_EQ(pressure_pa[1], 200e3);
}

struct Machine {
  explicit Machine(ControlValveKind kind) : brake(Params(kind), std::vector<double>(10, 13.0)) {}
  static PneumaticBrakeParams Params(ControlValveKind kind) {
    PneumaticBrakeParams params;
    params.valves[0].kind = kind;
    if (kind != ControlValveKind::kDirectRelease) params.valves[0].auxiliary_reservoir_l = 100.0;
    return params;
  }
  void Run(double to_s) { brake.PressuresAt(to_s, cylinder_pa); }
  PneumaticBrake brake;
  std::vector<double> cylinder_pa;
};

// The valve's cylinder stays empty, though the limiting valve would feed it; what the pipe falls further acts, 2.5
// times that less at most the 5.2 kPa of its threshold; the train does not notice; no air is lost.
TEST(BailOff, LetsTheLocomotiveGoAndNothingElse) {
  Machine machine(ControlValveKind::kDirectRelease);
  const double mass = machine.brake.AirMass();
  machine.brake.Command({1.0, BrakeCommandKind::kApply, 100.0});
  machine.brake.BailOff(0, 40.0, 45.0);
  machine.Run(39.9);
  const double before_pa = machine.cylinder_pa[0];
  EXPECT_GT(before_pa, 2.5 * (100e3 - 5.2e3));
  machine.Run(52.0);  // longer than the handle is held: its exhaust goes on
  EXPECT_LT(machine.cylinder_pa[0], 5e3);
  machine.Run(100.0);
  EXPECT_EQ(machine.cylinder_pa[0], 0.0);
  EXPECT_EQ(machine.brake.valve(0).Mode(), ControlValveMode::kBailedOff);
  for (int i = 1; i < 10; ++i) EXPECT_GT(machine.cylinder_pa[i], 2.5 * (100e3 - 5.2e3)) << i;
  machine.brake.Command({100.0, BrakeCommandKind::kApply, 140.0});
  machine.Run(160.0);
  // The limiting valve gives up to 70 kPa of it from the pipe.
  EXPECT_GT(machine.cylinder_pa[0], 2.5 * (40e3 - 5.2e3));
  EXPECT_LT(machine.cylinder_pa[0], 2.5 * 40e3 + 70e3);
  machine.brake.Command({160.0, BrakeCommandKind::kEmergency});
  machine.Run(220.0);
  EXPECT_GT(machine.cylinder_pa[0], 430e3);  // an emergency acts again
  EXPECT_NEAR((machine.brake.AirMass() + machine.brake.ReleasedMass() - machine.brake.SuppliedMass()) / mass, 1.0,
              1e-9);
}

TEST(BailOff, OfADistributorTakesItsReleaseTime) {
  Machine machine(ControlValveKind::kGraduatedRelease);
  machine.brake.Command({1.0, BrakeCommandKind::kApply, 150.0});
  machine.brake.BailOff(0, 40.0, 45.0);
  machine.Run(40.0);
  EXPECT_NEAR(machine.cylinder_pa[0], 380e3, 4e3);
  machine.Run(40.0 + 17.5);  // 40 kPa from 95 %, 0.9 s later from all of it
  EXPECT_NEAR(machine.cylinder_pa[0], 40e3, 4e3);
  machine.Run(100.0);
  EXPECT_LT(machine.cylinder_pa[0], 2e3);
  EXPECT_NEAR(machine.cylinder_pa[1], 380e3, 4e3);
}

TEST(BailOff, OfEcpLastsWhileItIsHeld) {
  Machine machine(ControlValveKind::kEcp);
  machine.brake.Command({1.0, BrakeCommandKind::kApply, 170.0});
  machine.brake.BailOff(0, 40.0, 45.0);
  machine.Run(40.0);
  const double applied_pa = machine.cylinder_pa[0];
  EXPECT_NEAR(applied_pa, 430e3, 2e3);
  machine.Run(45.0);
  EXPECT_NEAR(machine.cylinder_pa[0] / (applied_pa * std::exp(-5.0 / 15.0 * std::log(0.95 * 430.0 / 40.0))), 1.0, 0.01);
  machine.Run(80.0);
  EXPECT_NEAR(machine.cylinder_pa[0], machine.cylinder_pa[1], 5e3);
}

// In a train: from the scenario's list to the cylinders.
struct TrainRun {
  explicit TrainRun(const std::vector<std::string>& overrides, int threads = 1)
      : loaded(config::LoadScenario(ScenarioFile("drive_and_stop"), overrides)),
        transport(loaded.params, loaded.consist, threads),
        master(loaded.params, loaded.consist, transport, loaded.pressures) {
    master.AddObserver([this](const TrainRecord& record) {
      time_s.push_back(record.time_s);
      cylinder_pa.push_back(record.cylinder_pressure_pa);
      dynamic_n.push_back(record.held.dynamic_brake_n.empty() ? 0.0 : record.held.dynamic_brake_n[0]);
    });
  }
  void Go(double to_s) {
    while (!master.Done() && master.time_s() < to_s) master.Exchange();
  }
  config::LoadedScenario loaded;
  InProcessTransport transport;
  TrainMaster master;
  std::vector<double> time_s, dynamic_n;
  std::vector<std::vector<double>> cylinder_pa;
};

const std::vector<std::string> kBlended = {
    "train.consist[0].vehicle=c44ac",
    "brake=ab_head_end",
    "duration_s=30",
    "initial_speed_kmh=50",
    "model=ltd",
    "brake.locomotive_brake.blending_kpa_per_kn=2",
    "commands=[{time_s: 0, kind: apply, reduction_kpa: 80}, {time_s: 2, kind: dynamic_brake, notch: 4}, "
    "{time_s: 12, kind: bail_off}, {time_s: 14, kind: independent_brake, pressure_kpa: 150, vehicles: [1]}]"};

TEST(LocomotiveBrakes, AreCommandedByTheScenario) {
  TrainRun run(kBlended);
  run.master.Start();
  run.Go(30.0);
  const std::size_t wagon = run.loaded.consist.locomotives.size() + 2;
  bool has_blended = false;
  for (std::size_t i = 1; i < run.time_s.size(); ++i) {
    if (run.time_s[i] > 8.0 && run.time_s[i] < 11.9) has_blended = has_blended || run.dynamic_n[i] > 0.0;
    if (run.time_s[i] > 8.0 && run.time_s[i] < 11.9 && run.dynamic_n[i] > 0.0) {
      EXPECT_LT(run.cylinder_pa[i][0], run.cylinder_pa[i][wagon]);
    }
  }
  EXPECT_TRUE(has_blended);
  EXPECT_NEAR(run.cylinder_pa.back()[0], 150e3, 1e-6);
  EXPECT_GT(run.cylinder_pa.back()[wagon], 150e3);
}

TEST(LocomotiveBrakes, GoOnFromACheckpoint) {
  TrainRun whole(kBlended);
  whole.master.Start();
  whole.Go(15.0);  // in the middle of the independent brake's rise, the handle of the bail-off held
  while (!whole.master.RecordIsNext()) whole.master.Exchange();
  whole.master.AskForCheckpoint();
  whole.master.Exchange();
  const TrainCheckpoint checkpoint = whole.master.Checkpoint();
  whole.Go(30.0);
  TrainRun resumed(kBlended, 2);
  resumed.master.Resume(checkpoint);
  resumed.Go(30.0);
  EXPECT_EQ(resumed.master.state_digest(), whole.master.state_digest());
  EXPECT_EQ(resumed.cylinder_pa.back(), whole.cylinder_pa.back());
}

void ExpectRefused(const std::string& commands, const std::string& words, const std::string& brake = "ab_head_end") {
  std::string refusal;
  try {
    config::LoadScenario(ScenarioFile("drive_and_stop"), {"brake=" + brake, "commands=[" + commands + "]"});
  } catch (const strict_config::Error& error) {
    refusal = error.what();
  }
  EXPECT_NE(refusal.find(words), std::string::npos) << refusal;
}

TEST(LocomotiveBrakes, AreNotCommandedWrongly) {
  ExpectRefused("{time_s: 1, kind: independent_brake}", "pressure_kpa is missing");
  ExpectRefused("{time_s: 1, kind: independent_brake, pressure_kpa: 600}",
                "must be at most brake.locomotive_brake.maximum_independent_kpa, 450, got 600");
  ExpectRefused("{time_s: 1, kind: independent_brake, pressure_kpa: 100, vehicles: [-1]}", "must be a locomotive");
  ExpectRefused("{time_s: 1, kind: bail_off, pressure_kpa: 100}", "pressure_kpa is not");
  ExpectRefused("{time_s: 1, kind: bail_off}", "must not be bail_off with a brake of kind empirical", "calibrated");
}

}  // namespace
}  // namespace train_dynamics
