// Locomotives in a train: what their drives pull, what the wheels of the 2D model make of it, what the books say.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "ride.h"
#include "simulate.h"
#include "train_dynamics/train/run_summary.h"

namespace train_dynamics {
namespace {

const std::vector<std::string> kTrain = {"train.consist[0].vehicle=c44ac",
                                         "train.consist[0].model=2d",
                                         "train.consist[1].count=10",
                                         "train.consist[1].model=ltd",
                                         "train.consist[2].vehicle=c44ac_trailing",
                                         "train.consist[2].model=ltd",
                                         "train.consist[3].count=10",
                                         "train.consist[3].model=ltd",
                                         "train.connection=friction_gear",
                                         "brake=single_vehicle",
                                         "commands=[]",
                                         "initial_speed_kmh=0",
                                         "detail_vehicles=[]",
                                         "record_interval_s=0.1"};

std::vector<std::string> With(std::vector<std::string> overrides, const std::vector<std::string>& more) {
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

/// A short train of a 2D locomotive, ten wagons, an LTD locomotive and ten wagons.
struct PulledTrain {
  explicit PulledTrain(const std::vector<std::string>& more = {}, int threads = 1)
      : loaded(config::LoadScenario(ScenarioFile("emergency"), With(kTrain, more))),
        transport(loaded.params, loaded.consist, threads),
        master(loaded.params, loaded.consist, transport, loaded.pressures) {
    master.AddObserver([this](const TrainRecord& record) {
      last = record;
      if (!record.ledger) return;
      if (record.exchange == 0) initial_j = record.ledger->Stored();
      turned_over_j = std::max(turned_over_j, record.ledger->traction_work_j);
      residual_j = std::max(residual_j, std::abs(record.ledger->Residual(initial_j)));
    });
  }
  void Command(const NotchCommand& command) {
    for (std::size_t i = 0; i < master.locomotives().size(); ++i) master.locomotives().SetCommand(i, command);
  }
  void RunUntil(double time_s) {
    while (!master.Done() && master.time_s() < time_s - 1e-9) master.Exchange();
  }

  config::LoadedScenario loaded;
  InProcessTransport transport;
  TrainMaster master;
  TrainRecord last;
  double initial_j = 0.0, residual_j = 0.0, turned_over_j = 0.0;
};

TEST(Locomotives, AreTheVehiclesWithTraction) {
  PulledTrain train;
  ASSERT_EQ(train.master.locomotives().size(), 2u);
  EXPECT_EQ(train.master.locomotives().vehicle(0), 0);
  EXPECT_EQ(train.master.locomotives().vehicle(1), 11);
  EXPECT_EQ(train.loaded.consist.locomotives, (std::vector<int>{0, 11}));
}

TEST(Locomotives, PullATrainWithTheBooksClosed) {
  PulledTrain train({"duration_s=60"});
  train.master.Start();
  train.Command({8, 0});
  train.RunUntil(60.0);
  // The same as one mass on a point, by an integration of its own: efforts of 40 kN/s up to adhesion, 0.36 of 188.2 t,
  // or power.
  double inertia_kg = 0.0, speed_mps = 0.0, effort_n = 0.0;
  for (int i = 0; i < train.loaded.consist.vehicles(); ++i) {
    inertia_kg +=
        train.loaded.consist.vehicle(i).TotalMass() + EquivalentRotationalMass(train.loaded.consist.vehicle(i));
  }
  for (int ms = 0; ms < 60000; ++ms) {
    const double k = 3.6 * speed_mps;
    double resistance_n = 0.0;
    for (int i = 0; i < train.loaded.consist.vehicles(); ++i) {
      const VehicleParams& vehicle = train.loaded.consist.vehicle(i);
      const ResistanceCoefficients c = vehicle.Resistance();
      resistance_n += 1e-3 * vehicle.Weight() *
                      (c.constant_n_per_kn + c.linear_n_per_kn_kmh * k + c.quadratic_n_per_kn_kmh2 * k * k);
    }
    const double wanted_n = std::min(0.36 * 188.2e3 * 9.81, 3.03e6 / std::max(0.1, speed_mps));
    effort_n = std::min(wanted_n, effort_n + 40.0);
    speed_mps += 1e-3 * std::max(0.0, 2.0 * effort_n - resistance_n) / inertia_kg;
  }
  EXPECT_GT(speed_mps, 8.0);
  // Slack, springs and the creep of the 2D locomotive's wheels are not in the one mass.
  EXPECT_NEAR(train.last.mean_speed_mps, speed_mps, 5e-3 * speed_mps);
  EXPECT_LT(train.residual_j, 1e-6 * train.turned_over_j);
  EXPECT_GT(train.turned_over_j, 1e6);
  // Work at the rims: kinetic energy and losses.
  const EnergyLedger& ledger = *train.last.ledger;
  EXPECT_NEAR(ledger.traction_work_j, ledger.Stored() - train.initial_j + ledger.Dissipated(),
              1e-6 * ledger.traction_work_j);
  EXPECT_GT(train.master.locomotives().EnergyTaken(), ledger.traction_work_j / 0.36);
  EXPECT_NEAR(train.master.locomotives().FuelMass(), train.master.locomotives().EnergyTaken() / 42.7e6, 1e-9);
}

TEST(Locomotives, TheLedgerClosesWithEveryTermOfEq1InBothModels) {
  for (const char* model : {"2d", "ltd"}) {
    const Outcome outcome =
        Simulate("emergency", {std::string("model=") + model,
                               "train={name: all, connection: friction_gear, consist: [{vehicle: c44ac}, {vehicle: "
                               "ore_wagon_loaded, count: "
                               "4}, {vehicle: c44ac_trailing}]}",
                               "track={name: hill, grades: [{from_m: -1000, grade_percent: 0.5}, {from_m: 80, "
                               "grade_percent: -1}], curves: "
                               "[{from_m: 20, to_m: 150, radius_m: 400}, {from_m: 150, to_m: 300, radius_m: -600}]}",
                               "brake=single_vehicle",
                               "commands=[{time_s: 0, kind: throttle, notch: 8}, {time_s: 8, kind: dynamic_brake, "
                               "notch: 8}, {time_s: 20, "
                               "kind: apply, reduction_kpa: 80}]",
                               "initial_speed_kmh=40", "initial_slack=bunched", "duration_s=32",
                               "record_interval_s=0.5", "detail_vehicles=[]"});
    ExpectLedgerCloses(outcome, model);
    EXPECT_GT(outcome.ledger.traction_work_j, 1e6) << model;
    EXPECT_NE(outcome.ledger.gravity_work_j, 0.0) << model;
    for (const auto& [element, energy] : outcome.ledger.dissipated_j) {
      if (element == "brake_shoes" || element == "dynamic_brake" || element == "rolling_resistance" ||
          element == "curving_resistance" || element == "air_drag" || element == "draft_gears") {
        EXPECT_GT(energy, 1e3) << model << ": " << element;
      }
    }
  }
}

TEST(Locomotives, DynamicBrakeWaitsForTheChangeOver) {
  PulledTrain train({"duration_s=60", "initial_speed_kmh=40"});
  train.master.Start();
  train.Command({4, 0});
  train.RunUntil(10.0);
  EXPECT_GT(train.last.held.traction_n[0], 5e4);
  EXPECT_EQ(train.last.held.dynamic_brake_n[0], 0.0);
  train.Command({0, 8});
  train.RunUntil(15.0);
  EXPECT_EQ(train.last.held.traction_n[0], 0.0);
  EXPECT_EQ(train.last.held.dynamic_brake_n[0], 0.0);
  train.RunUntil(40.0);
  EXPECT_GT(train.last.held.dynamic_brake_n[0], 2e5);
  EXPECT_GT(train.last.held.dynamic_brake_n[11], 2e5);
  EXPECT_EQ(train.last.held.dynamic_brake_n[1], 0.0);
  train.RunUntil(60.0);
  double dynamic_brake_j = 0.0;
  for (const auto& [element, energy] : train.last.ledger->dissipated_j) {
    if (element == "dynamic_brake") dynamic_brake_j = energy;
  }
  EXPECT_GT(dynamic_brake_j, 1e6);
  EXPECT_LT(train.residual_j, 1e-6 * train.initial_j);
}

TEST(Locomotives, GoOnFromACheckpointToTheSameBits) {
  const std::vector<std::string> brief = {"duration_s=12", "initial_speed_kmh=30"};
  PulledTrain whole(brief);
  whole.master.Start();
  whole.Command({6, 0});
  whole.RunUntil(5.9);
  whole.Command({0, 4});
  whole.RunUntil(5.999);  // while the traction falls; the exchange that follows ends with a record
  whole.master.AskForCheckpoint();
  whole.RunUntil(6.0);
  const TrainCheckpoint checkpoint = DecodeTrainCheckpoint(Encode(whole.master.Checkpoint()));
  whole.RunUntil(12.0);
  PulledTrain resumed(brief, 2);
  resumed.master.Resume(checkpoint);
  resumed.Command({0, 4});
  resumed.RunUntil(12.0);
  EXPECT_EQ(whole.master.state_digest(), resumed.master.state_digest());
  EXPECT_EQ(whole.master.locomotives().EnergyTaken(), resumed.master.locomotives().EnergyTaken());
  EXPECT_NE(whole.last.held.traction_n, std::vector<double>());
  PulledTrain other(brief);
  other.master.Start();
  other.Command({6, 0});
  other.RunUntil(12.0);
  EXPECT_NE(whole.master.state_digest(), other.master.state_digest());
}

TEST(Locomotives, ObeyCommandsWithTheDelayOfTheirGroup) {
  const std::vector<std::string> more = {"duration_s=8", "initial_speed_kmh=10", "train.consist[2].command_delay_s=1.5",
                                         "commands=[{time_s: 1, kind: throttle, notch: 8}, "
                                         "{time_s: 4, kind: throttle, notch: 0, vehicles: [1]}]"};
  PulledTrain train(more);
  train.master.Start();
  train.RunUntil(2.0);
  EXPECT_NEAR(train.last.held.traction_n[0], 40e3, 50.0);  // 1 s at 40 kN/s, but for the exchange
  EXPECT_EQ(train.last.held.traction_n[11], 0.0);
  train.RunUntil(3.5);
  EXPECT_NEAR(train.last.held.traction_n[0], 100e3, 50.0);
  EXPECT_NEAR(train.last.held.traction_n[11], 40e3, 50.0);
  train.RunUntil(3.599);
  train.master.AskForCheckpoint();
  train.RunUntil(3.6);
  const TrainCheckpoint checkpoint = train.master.Checkpoint();
  train.RunUntil(8.0);
  EXPECT_EQ(train.last.held.traction_n[0], 0.0);
  EXPECT_NEAR(train.last.held.traction_n[11], 5.5 * 40e3, 50.0);
  PulledTrain resumed(more);
  resumed.master.Resume(checkpoint);
  resumed.RunUntil(8.0);
  EXPECT_EQ(train.master.state_digest(), resumed.master.state_digest());
}

TEST(LocomotiveCommands, ThatTheTrainCannotObeyAreRefused) {
  const TrainParams train = config::LoadScenario(ScenarioFile("emergency"), kTrain).params.train;
  const auto text = [&train](const LocomotiveCommand& command) {
    const std::vector<BrokenRule> broken = JudgeLocomotiveCommand(command, "commands[0]", train);
    return broken.empty() ? "" : broken[0].key + " " + broken[0].text;
  };
  EXPECT_EQ(text({0.0, LocomotiveCommandKind::kThrottle, 8.0, {}}), "");
  EXPECT_EQ(text({0.0, LocomotiveCommandKind::kDynamicBrake, 8.0, {1, 12}}), "");
  EXPECT_EQ(text({0.0, LocomotiveCommandKind::kThrottle, 9.0, {}}),
            "commands[0].notch must be at most 8, the highest notch of a throttle of this train");
  EXPECT_EQ(text({0.0, LocomotiveCommandKind::kThrottle, 8.0, {2}}),
            "commands[0].vehicles[0] must be a locomotive: a vehicle with traction");
  EXPECT_NE(text({0.0, LocomotiveCommandKind::kThrottle, 8.0, {200}}), "");
  TrainParams without = train;
  without.consist[0].vehicle.traction->dynamic_brake.reset();
  const std::vector<BrokenRule> broken =
      JudgeLocomotiveCommand({0.0, LocomotiveCommandKind::kDynamicBrake, 4.0, {}}, "commands[0]", without);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].key, "commands[0].kind");
  without.consist = {train.consist[1]};
  EXPECT_EQ(JudgeLocomotiveCommand({0.0, LocomotiveCommandKind::kThrottle, 4.0, {}}, "commands[0]", without).size(),
            1u);
}

TEST(Locomotives, TrainsWithoutThemSendNothingOfThem) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("emergency"), {"model=ltd"});
  Locomotives none(loaded.consist, {});
  EXPECT_TRUE(none.empty());
  LoadArrays loads;
  none.Advance(5e-4, 1e-3, std::vector<double>(242, 20.0), loads);
  EXPECT_TRUE(loads.traction_n.empty());
  EXPECT_TRUE(loads.dynamic_brake_n.empty());
}

VehicleParams Locomotive(const std::string& name) {
  VehicleParams p = LoadPart<VehicleParams>("vehicles/" + name + ".yaml");
  p.propulsion_resistance.law = PropulsionResistanceLaw::kAbc;
  p.propulsion_resistance.constant_n_per_kn = p.propulsion_resistance.linear_n_per_kn_kmh = 0.0;
  p.propulsion_resistance.quadratic_n_per_kn_kmh2 = 0.0;
  return p;
}

// Torque on the driven wheelsets: the vehicle takes F / (m + m_e), its driven wheels creep, those without drive do not.
TEST(TractionInTwoDimensions, AcceleratesMassAndWheelsets) {
  for (const std::vector<int>& driven : {std::vector<int>{}, std::vector<int>{1, 3, 4, 6}}) {
    VehicleParams p = Locomotive("c44ac");
    p.traction->driven_wheelsets = driven;
    RideOn<3> ride(p, TrackParams(), 3.0);
    ride.loads.traction_n = 300e3;
    ride.Run(4.0);  // the carbody's rocking dies down
    const double v0 = ride.Speed();
    ride.Run(4.0);
    const double a = 300e3 / (p.TotalMass() + EquivalentRotationalMass(p));
    EXPECT_NEAR((ride.Speed() - v0) / 4.0, a, 3e-3 * a) << driven.size();  // creep grows with the speed, a little
    EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
    const double load_n = p.Weight() / 6.0;
    for (int i = 0; i < 6; ++i) {
      const bool drives = p.traction->Drives(i);
      const double creepage = ride.output.creepage[i];
      if (drives) {
        EXPECT_LT(creepage, -1e-5) << i;  // driving: the tread is faster than the rail
      } else {
        EXPECT_GT(creepage, 0.0) << i;  // pulled along by the rail
        EXPECT_LT(creepage, 1e-4) << i;
      }
      EXPECT_GT(ride.output.normal_force_n[i], 0.5 * load_n);
    }
  }
}

// The frames get the opposite of the wheelsets' torque: angular momentum of the whole about the rail.
//   sum x_i N_i = -a (sum m h + sum J / r),  without couplers and drag; a > 0 presses the rear wheelsets
TEST(TractionInTwoDimensions, AxleLoadsBalanceTheAngularMomentumAboutTheRail) {
  VehicleParams p = Locomotive("c44ac");
  RideOn<3> ride(p, TrackParams(), 2.0);
  ride.loads.traction_n = 300e3;
  ride.Run(12.0);
  double moment = 0.0, inertia = 0.0, v_before[11], spin_before[11];
  const double v0 = ride.Speed();
  for (int b = 0; b < 11; ++b) v_before[b] = ride.state.velocity.x[b], spin_before[b] = ride.state.velocity.pitch[b];
  constexpr int kSteps = 2000;  // the mean over the rest of the rocking
  for (int step = 0; step < kSteps; ++step) {
    ride.Run(1e-3);
    for (int i = 0; i < 6; ++i) moment += ride.wagon.wheelset_offset_m[i] * ride.output.normal_force_n[i] / kSteps;
  }
  const double time_s = 1e-3 * kSteps;
  const double heights[11] = {2.0, 0.8, 0.8, 0.65, 0.65, 0.5334, 0.5334, 0.5334, 0.5334, 0.5334, 0.5334};
  for (int b = 0; b < 11; ++b) {
    inertia += ride.wagon.mass_kg[b] * heights[b] * (ride.state.velocity.x[b] - v_before[b]) / time_s;
    inertia += ride.wagon.inertia_kgm2[b] * (ride.state.velocity.pitch[b] - spin_before[b]) / time_s;
  }
  EXPECT_GT((ride.Speed() - v0) / time_s, 1.4);
  EXPECT_NEAR(moment, -inertia, 3e-3 * std::abs(inertia));  // small angles; what is left of the rocking
}

TEST(TractionInTwoDimensions, CreepLimitsIt) {
  VehicleParams p = Locomotive("c44ac");
  p.wheel_rail.adhesion.friction_coefficient = 0.1;
  RideOn<3> ride(p, TrackParams(), 1.0);
  ride.loads.traction_n = 500e3;  // 0.27 of the weight
  ride.Run(2.0);
  const double v0 = ride.Speed();
  ride.Run(1.0);
  EXPECT_LT(ride.Speed() - v0, 0.1 * 9.81);                                       // no more than the rail gives
  EXPECT_GT(ride.state.velocity.pitch[kWheelset1] * 0.5334, 3.0 * ride.Speed());  // the wheels spin
}

TEST(SlipControl, TakesTorqueAtOnceAndGivesItBackSlowly) {
  const SlipControlParams p;
  EXPECT_EQ(NextReduction(p, 0.0, 10.0, 10.15), 0.0);                  // within 2 %
  EXPECT_NEAR(NextReduction(p, 0.0, 10.0, 11.2), 0.3 * 1.0, 1e-12);    // 1 m/s beyond
  EXPECT_NEAR(NextReduction(p, 0.0, 1.0, 2.1), 0.3 * 1.0, 1e-12);      // beyond 0.1 m/s
  EXPECT_NEAR(NextReduction(p, 0.5, 10.0, 10.0), 0.5 - 0.001, 1e-12);  // 20 % per second, every 5 ms
  EXPECT_EQ(NextReduction(p, 0.0, 10.0, 90.0), 1.0);
  EXPECT_EQ(NextReduction(p, 0.0, 10.0, 3.0), 0.0);  // braked wheels are none of its business
}

// A 2D locomotive before five vehicles on a greasy rail: its effort is several times what the rail gives.
struct GreasyStart {
  explicit GreasyStart(bool with_slip_control)
      : train({"train.consist[1].count=2", "train.consist[2].count=1", "train.consist[3].count=2", "duration_s=20",
               "train.consist[0].vehicle.wheel_rail.adhesion=low",
               std::string("train.consist[0].vehicle.traction.slip_control.gain_per_mps=") +
                   (with_slip_control ? "0.3" : "1e-9")}) {}
  PulledTrain train;
};

TEST(SlipControl, KeepsAGreasyStartFromSpinning) {
  double speed_mps[2], largest_creepage[2] = {0.0, 0.0};
  for (const bool with : {false, true}) {
    GreasyStart start(with);
    start.train.master.AddObserver([&](const TrainRecord& record) {
      if (record.time_s > 10.0)
        largest_creepage[with] = std::max(largest_creepage[with], std::abs(record.vehicles.creepage[0]));
    });
    start.train.master.Start();
    start.train.Command({8, 0});
    start.train.RunUntil(20.0);
    speed_mps[with] = start.train.last.vehicles.speed_mps[0];
    EXPECT_LT(start.train.residual_j, 1e-6 * start.train.turned_over_j + 1e-6 * start.train.initial_j);
  }
  EXPECT_GT(largest_creepage[0], 2.0);  // the wheels spin away
  EXPECT_LT(largest_creepage[1], 1.5);
  EXPECT_GT(speed_mps[1], speed_mps[0]);  // falling friction: who slips less pulls more
}

TEST(SlipControl, GoesOnFromACheckpointToTheSameBits) {
  GreasyStart whole(true);
  whole.train.master.Start();
  whole.train.Command({8, 0});
  whole.train.RunUntil(11.999);
  whole.train.master.AskForCheckpoint();
  whole.train.RunUntil(12.0);
  const TrainCheckpoint checkpoint = DecodeTrainCheckpoint(Encode(whole.train.master.Checkpoint()));
  whole.train.RunUntil(14.0);
  GreasyStart resumed(true);
  resumed.train.master.Resume(checkpoint);
  resumed.train.RunUntil(14.0);
  EXPECT_EQ(whole.train.master.state_digest(), resumed.train.master.state_digest());
}

}  // namespace
}  // namespace train_dynamics
