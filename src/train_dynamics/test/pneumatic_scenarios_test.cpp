// The shipped scenarios of the pneumatic brake, run whole: what each of them is there to show.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "simulate.h"
#include "strict_config/error_list.h"

namespace train_dynamics {
namespace {

struct Recorded {
  std::vector<double> time_s;
  std::vector<std::vector<double>> cylinder_pa, pipe_pa, auxiliary_pa, mode;
  std::vector<double> speed_kmh;
  std::uint64_t digest = 0;

  std::size_t At(double t) const {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t - 1e-6) - time_s.begin());
  }
  int InEmergency(double t) const {
    const std::vector<double>& m = mode[At(t)];
    return static_cast<int>(std::count(m.begin(), m.end(), 3.0));
  }
  double MeanCylinder(double t) const {
    double sum = 0.0;
    for (double p : cylinder_pa[At(t)]) sum += p;
    return sum / static_cast<double>(cylinder_pa[At(t)].size());
  }
};

Recorded Simulated(const std::string& scenario, const std::vector<std::string>& overrides = {}, int threads = 1) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile(scenario), overrides);
  InProcessTransport transport(loaded.params, loaded.consist, threads);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  Recorded run;
  master.AddObserver([&](const TrainRecord& record) {
    run.time_s.push_back(record.time_s);
    run.cylinder_pa.push_back(record.cylinder_pressure_pa);
    run.pipe_pa.push_back(record.brake.pipe_pressure_pa);
    run.auxiliary_pa.push_back(record.brake.auxiliary_reservoir_pa);
    run.mode.push_back(record.brake.valve_mode);
    run.speed_kmh.push_back(3.6 * record.mean_speed_mps);
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  run.digest = master.state_digest();
  return run;
}

TEST(Scenario, Charging) {
  const Recorded run = Simulated("charging");
  EXPECT_EQ(run.pipe_pa.front().back(), 0.0);
  EXPECT_GT(run.pipe_pa.back().back(), 0.95 * 600e3);
  for (std::size_t i = 1; i < run.time_s.size(); ++i)  // nowhere anything brakes
    ASSERT_EQ(run.cylinder_pa[i].back(), 0.0);
}

// An applied AB valve, filled up. It stops feeding at 1.7 kPa between reservoir and pipe and feeds again at 5.2, so the
// reservoir stands between; 0.2 kPa for what a pipe falling at 20 kPa/s does in two steps of 5 ms. The cylinder has
// 41.0 / 16.4 = 2.5 times what its reservoir gave since it was at `before_pa`, and what the limiting valve took from
// the pipe, which ends at 70 kPa.
void ExpectApplied(const Recorded& run, double t, std::size_t vehicle, double before_pa) {
  const std::size_t i = run.At(t);
  const double auxiliary = run.auxiliary_pa[i][vehicle], above = auxiliary - run.pipe_pa[i][vehicle];
  EXPECT_TRUE(run.mode[i][vehicle] == 1.0 || run.mode[i][vehicle] == 2.0)
      << vehicle;  // feeds at times while the pipe still falls
  EXPECT_GE(above, 1.7e3 - 0.2e3) << vehicle;
  EXPECT_LE(above, 5.2e3 + 0.2e3) << vehicle;
  const double of_pipe = run.cylinder_pa[i][vehicle] - 2.5 * (before_pa - auxiliary);
  EXPECT_GE(of_pipe, -0.1e3) << vehicle;
  EXPECT_LE(of_pipe, 70e3) << vehicle;
}

// The 428.6 kPa of equalisation, 600 kPa 2.5/3.5, need a pipe below the reservoir at the end; with 170 kPa a valve laps
// 1.7 to 5.2 kPa before it: 2.5 (170 - 5.2) = 412.0 kPa at least, where the pipe has arrived at 430 kPa.
TEST(Scenario, FullServiceAb) {
  const Recorded run = Simulated("full_service_ab");
  EXPECT_EQ(run.InEmergency(119.0), 0);
  const std::vector<double>& at_40 = run.cylinder_pa[run.At(40.0)];
  EXPECT_GT(at_40.front(), at_40.back() + 50e3);  // the tail is behind
  ExpectApplied(run, 40.0, 0, 600e3);
  for (std::size_t v = 0; v < 150; ++v) {
    SCOPED_TRACE(v);
    ExpectApplied(run, 119.9, v, 600e3);
    const std::size_t end = run.At(119.9);
    EXPECT_NEAR(run.pipe_pa[end][v], 430e3, 2e3);
    EXPECT_GT(run.cylinder_pa[end][v], 2.5 * (600e3 - run.pipe_pa[end][v] - 5.4e3));
    EXPECT_LT(run.cylinder_pa[end][v], 428.6e3);
  }
}

// Speed of a rigid train of ore wagons of the paper with the run's mean cylinder pressure: Eq 3 and Eq 5, 160.1 t and
// the wheelsets' 4 x 679 kg m2 / (0.485 m)^2 = 11.5 t.
double RigidSpeedKmh(const Recorded& run, double initial_kmh, double t_end) {
  const double mass = 147599.8 + 2.0 * (1103.9 + 1665.5) + 4.0 * 1731.8 + 8.0 * 6.0;
  const double inert = mass + 4.0 * 679.0 / (0.485 * 0.485);
  double v = initial_kmh;  // km/h
  for (std::size_t i = 1; i < run.time_s.size() && run.time_s[i] <= t_end + 1e-6 && v > 0.0; ++i) {
    const double brake = 0.46035 * run.MeanCylinder(run.time_s[i]) * 0.322 * (v + 150.0) / (2.0 * v + 150.0);
    const double drag = mass * 9.81e-3 * (0.92 + 0.0048 * v + 0.000125 * v * v);
    v -= 3.6 * (brake + drag) / inert * (run.time_s[i] - run.time_s[i - 1]);
  }
  return std::max(v, 0.0);
}

// 514 kPa are 0.37 m/s2 on average: 22.2 m/s need more than 60 s. At rest before 70 s, where the paper's 430 kPa still
// leave 9.8 km/h.
TEST(Scenario, EmergencyAb) {
  const Recorded run = Simulated("emergency_ab");
  EXPECT_EQ(run.InEmergency(10.0), 242);
  for (double p : run.cylinder_pa.back()) EXPECT_NEAR(p, 600e3 * 6.0 / 7.0, 0.5e3);  // both reservoirs
  EXPECT_NEAR(run.speed_kmh[run.At(30.0)], RigidSpeedKmh(run, 80.0, 30.0), 0.3);
  EXPECT_NEAR(run.speed_kmh[run.At(60.0)], RigidSpeedKmh(run, 80.0, 60.0), 0.3);
  EXPECT_LT(run.speed_kmh.back(), 0.1);
}

// 70 kPa, released for 15 s, then 50 kPa: the reservoirs of the rear are still at 530 kPa, the pipe settles at 550 kPa,
// and their valves let go though the driver applies; 100 kPa catches them.
TEST(Scenario, CycleBrakingLongGrade) {
  const Recorded run = Simulated("cycle_braking_long_grade");
  const auto released = [&](double t) {
    const std::vector<double>& m = run.mode[run.At(t)];
    return std::count(m.begin(), m.end(), 0.0);
  };
  EXPECT_EQ(released(64.0), 0);
  EXPECT_LT(released(95.0), 40);  // the application has run through the train
  EXPECT_GT(released(179.0), 75);
  EXPECT_EQ(run.cylinder_pa[run.At(179.0)].back(), 0.0);
  EXPECT_EQ(released(299.0), 0);
  // The tail's reservoirs have 546 kPa at 180 s: 100 kPa below 600 are only 46 below them. So the tail's cylinders have
  // 2.5 (46 - 5.2) kPa at least, and with all that the limiting valve may add no more than 2.5 (46 - 1.7) + 70, where
  // the head's, that never let go, have 2.5 (100 - 5.2) at least.
  const double tail_reservoir = run.auxiliary_pa[run.At(179.0)].back();
  EXPECT_LT(tail_reservoir, 550e3);  // not above the pipe that the driver holds
  ExpectApplied(run, 299.0, 149, tail_reservoir);
  EXPECT_GT(run.cylinder_pa[run.At(299.0)].back(), 2.5 * (tail_reservoir - 500e3 - 5.4e3));
  EXPECT_LT(run.cylinder_pa[run.At(299.0)].back(), 2.5 * (tail_reservoir - 500e3 - 1.5e3) + 70e3);
  EXPECT_GT(run.cylinder_pa[run.At(299.0)].front(), 2.5 * (100e3 - 5.4e3));
  EXPECT_EQ(run.InEmergency(299.0), 0);
}

TEST(Scenario, EcpAgainstHeadEnd) {
  const Recorded ecp = Simulated("ecp_against_head_end"),
                 head = Simulated("ecp_against_head_end", {"brake=ab_head_end"});
  // Each beside its own full pressure. ECP is ahead until both are full, and ever less so.
  const auto ratio = [&](double after_s) {
    return (ecp.MeanCylinder(2.0 + after_s) / ecp.MeanCylinder(60.0)) /
           (head.MeanCylinder(2.0 + after_s) / head.MeanCylinder(60.0));
  };
  for (double t = 1.0; t < 20.0; t += 1.0) EXPECT_GT(ratio(t), ratio(t + 1.0)) << t;
  EXPECT_GT(ratio(15.0), 1.0);
  EXPECT_NEAR(ratio(30.0), 1.0, 0.005);
  // A wave of 290 m/s and a linear build-up of 10 s: 1 / (1 - L / 5800 m) at 10 s. The published 100 cars of 60 ft
  // (1829 m) have 1.46, accepted from 1.38 to 1.52 (pneumatic_brake_test); this train of 1575 m is shorter: 1.373. The
  // same band, -0.08 and +0.06, beside it.
  const double estimate = 1.0 / (1.0 - 150 * 10.5 / 5800.0);
  EXPECT_GT(ratio(10.0), estimate - 0.08);
  EXPECT_LT(ratio(10.0), estimate + 0.06);
}

TEST(Scenario, HoseParted) {
  const Recorded run = Simulated("hose_parted");
  EXPECT_EQ(run.InEmergency(4.9), 0);
  EXPECT_EQ(run.InEmergency(12.0), 150);
  // From the hose to both sides at once.
  EXPECT_GT(run.mode[run.At(5.5)][74], 2.5);
  EXPECT_GT(run.mode[run.At(5.5)][75], 2.5);
  EXPECT_LT(run.mode[run.At(5.5)][0], 2.5);
}

TEST(Scenario, DistributedPowerRadioLoss) {
  const Recorded lost = Simulated("distributed_power_radio_loss");
  const Recorded heard = Simulated("distributed_power_radio_loss", {"brake.sources[1].radio_lost_from_s=1000",
                                                                    "brake.sources[1].radio_lost_to_s=2000"});
  EXPECT_LT(lost.cylinder_pa[lost.At(30.0)][110], 0.3 * heard.cylinder_pa[heard.At(30.0)][110]);
  EXPECT_EQ(lost.InEmergency(100.0), 0);
  // Once its valve has lapped, 45 s after the loss, the application reaches the tail.
  EXPECT_GT(lost.cylinder_pa[lost.At(119.0)][110], 0.6 * heard.cylinder_pa[heard.At(119.0)][110]);
}

// The cylinder of a distributor of 500 kPa with 380 kPa at most over the recorded pipe: to 95 % in fill_s, from 95 %
// down to 40 kPa in release_s, never below the first step of a tenth while it is applied.
double DistributorPa(const Recorded& run, std::size_t vehicle, double fill_s, double release_s, double t_end) {
  const double fill = std::log(10.5) / fill_s, release = std::log(0.95 * 380.0 / 40.0) / release_s;
  double p = 0.0;
  bool applied = false;
  for (std::size_t i = 1; i < run.time_s.size() && run.time_s[i] <= t_end + 1e-6; ++i) {
    const double below = 500e3 - run.pipe_pa[i][vehicle], dt = run.time_s[i] - run.time_s[i - 1];
    applied = below > (applied ? 5e3 : 15e3);
    const double goal = applied ? std::clamp(3.8 / 1.5 * below, 38e3, 380e3) : 0.0;
    if (p < goal) {
      p = std::min(goal, p + dt * std::max(p < 38e3 ? 38e3 : 0.0, fill * (1.05 * goal - p)));
    } else {
      p -= dt * release * (p - goal);
    }
  }
  return p;
}

// Why the pipe is charged slowly: its reservoirs gave 380 kPa to cylinders of 16.4 l, 62 kPa each, and 50 x 100 l take
// some 3.7 kg back through the pipe's one end. What the reservoirs and the pipe gain behind a vehicle passes it;
// friction alone, steady, makes the gradient:  p_i^2 - p_(i+1)^2 = f dx / D  R T  (M / A)^2.
double GradientOfFriction(const Recorded& run, double t) {
  const double length_m = 1.10 * 10.5, diameter_m = 0.032, area_m2 = 0.25 * 3.14159265 * diameter_m * diameter_m;
  const double rt = 287.05 * 293.15, pipe_m3 = area_m2 * length_m + 0.9e-3, reservoir_m3 = 0.1;
  const std::size_t now = run.At(t), before = run.At(t - 1.0), after = run.At(t + 1.0);
  const std::size_t vehicles = run.pipe_pa[now].size();
  std::vector<double> behind_kgps(vehicles, 0.0);
  for (std::size_t v = vehicles - 1; v > 0; --v) {
    const double gain_kgps = 0.5 / rt *
                             (reservoir_m3 * (run.auxiliary_pa[after][v] - run.auxiliary_pa[before][v]) +
                              pipe_m3 * (run.pipe_pa[after][v] - run.pipe_pa[before][v]));
    behind_kgps[v - 1] = behind_kgps[v] + gain_kgps;
  }
  const double atmosphere_pa = 101325.0;
  double p = run.pipe_pa[now][0] + atmosphere_pa;
  for (std::size_t v = 0; v + 1 < vehicles; ++v) {
    const double flow = behind_kgps[v], reynolds = flow * diameter_m / (area_m2 * 1.81e-5);
    const double f = reynolds > 40000.0  ? 0.04
                     : reynolds > 4000.0 ? 0.13977 * std::pow(reynolds, -0.11781)
                     : reynolds > 2000.0 ? 0.000137 * std::pow(reynolds, 0.717)
                                         : 64.0 / std::max(reynolds, 1.0);
    p = std::sqrt(p * p - f * length_m / diameter_m * rt * flow * flow / (area_m2 * area_m2));
  }
  return run.pipe_pa[now][0] + atmosphere_pa - p;
}

TEST(Scenario, MixedGP) {
  const Recorded run = Simulated("mixed_g_p", {"duration_s=240"});
  // Vehicles 6 (G) and 7 (P) are neighbours and have nearly one pipe pressure; the locomotive has another, earlier one.
  const std::vector<double>& early = run.cylinder_pa[run.At(12.0)];
  EXPECT_NEAR(run.pipe_pa[run.At(12.0)][5], run.pipe_pa[run.At(12.0)][6], 10e3);
  EXPECT_LT(early[5], 0.6 * early[6]);
  for (double t : {12.0, 24.0, 44.0}) {
    EXPECT_NEAR(run.cylinder_pa[run.At(t)][5], DistributorPa(run, 5, 24.0, 52.5, t), 5e3) << t;
    EXPECT_NEAR(run.cylinder_pa[run.At(t)][10], DistributorPa(run, 10, 4.0, 17.5, t), 5e3) << t;
  }
  // Let down by a step, to 2.533 x 70 kPa; 19 s are two time constants of P (8 s) with the pipe's rise before them:
  // above it still, below what it was.
  const std::vector<double>& graduated = run.cylinder_pa[run.At(44.0)];
  EXPECT_GT(graduated[10], 2.5333 * 70e3);
  EXPECT_LT(graduated[10], 0.65 * run.cylinder_pa[run.At(24.9)][10]);
  for (double t : {60.0, 80.0, 100.0})
    EXPECT_NEAR(GradientOfFriction(run, t) / (run.pipe_pa[run.At(t)].front() - run.pipe_pa[run.At(t)].back()), 1.0,
                0.03)
        << t;
  // A distributor lets go once its pipe is within 5 kPa; until then it has the first step at least. How long that takes
  // the pipe: docs/air_brake.md.
  for (std::size_t v = 0; v < 50; ++v) {
    const double pipe = run.pipe_pa[run.At(119.9)][v], cylinder = run.cylinder_pa[run.At(119.9)][v];
    if (pipe < 494e3) {
      EXPECT_GT(cylinder, 37.9e3) << v;
    }
    EXPECT_LT(run.cylinder_pa.back()[v], 1e3) << v;
  }
}

// Whatever moves the vehicles; in the middle of waves, with both models. Over nodes: test/distributed_train.py; from
// checkpoints: checkpoint_test.
TEST(Scenario, TheSameDigestFromAnyNumberOfThreads) {
  const std::vector<std::string> few = {"duration_s=5.5"};
  for (const char* scenario : {"hose_parted", "emergency_ab", "mixed_g_p", "ecp_against_head_end"}) {
    const std::uint64_t digest = Simulated(scenario, few).digest;
    for (int threads : {2, 3}) EXPECT_EQ(Simulated(scenario, few, threads).digest, digest) << scenario;
  }
  const std::vector<std::string> two_d = {"duration_s=2.5", "model=2d"};
  EXPECT_EQ(Simulated("emergency_ab", two_d).digest, Simulated("emergency_ab", two_d, 3).digest);
  EXPECT_NE(Simulated("hose_parted", few).digest,
            Simulated("hose_parted", {"duration_s=5", "brake.charged_pressure_kpa=590"}).digest);
}

// Twelve wagons without air on a grade of 1 %: hand brakes of 10 % of the weight on two of them hold 1.67 % and more;
// of 4 % they hold 0.67 %, and once all wagons roll the train gains (1 % - 0.67 % - 0.092 % of resistance) g, less by
// the 1.3 % of the wheelsets' inertia.
TEST(Scenario, HandBrakesHoldWhereThereIsNoAir) {
  const auto run = [](const std::string& ratio) {
    return Simulated("cycle_braking_long_grade",
                     {"train.consist[0].count=2", "train.consist[1].count=10",
                      "train.consist[0].vehicle.brake_rigging.hand_brake_ratio=" + ratio, "commands=[]",
                      "brake.initial_pressure_kpa=0", "initial_speed_kmh=0", "duration_s=40"});
  };
  EXPECT_NEAR(run("0.1").speed_kmh.back(), 0.0, 0.01);
  const Recorded rolling = run("0.04");
  const double gained_mps = (rolling.speed_kmh[rolling.At(40.0)] - rolling.speed_kmh[rolling.At(30.0)]) / 3.6;
  EXPECT_NEAR(gained_mps / (10.0 * 9.81 * (0.01 - 0.04 / 6.0 - 0.92e-3) / 1.013), 1.0, 0.02);
}

// What is refused, with the words that tell how to mend it.
std::string Refusal(const std::vector<std::string>& overrides) {
  try {
    config::LoadScenario(ScenarioFile("full_service_ab"), overrides);
  } catch (const strict_config::Error& error) {
    return error.what();
  }
  return "";
}
void ExpectRefused(const std::vector<std::string>& overrides, const std::string& words) {
  EXPECT_NE(Refusal(overrides).find(words), std::string::npos) << Refusal(overrides);
}

TEST(Scenario, OfAPneumaticBrakeIsRefused) {
  EXPECT_EQ(Refusal({}), "");
  ExpectRefused({"brake.charged_pressure_kpa=1100"}, "charged_pressure_kpa must be in [300, 1000]");
  ExpectRefused({"brake.charged_pressure_kpa=200"}, "charged_pressure_kpa must be in [300, 1000]");
  ExpectRefused({"brake.pipe.inner_diameter_mm=60"}, "inner_diameter_mm must be in [20, 50]");
  ExpectRefused({"brake.closed_angle_cocks=[150]"}, "must be in [1, 149]");
  ExpectRefused({"brake.parted_hoses=[{behind_vehicle: 150, time_s: 1}]"}, "must be in [1, 149]");
  ExpectRefused({"brake.sources[0].vehicle=151"}, "sources[0].vehicle must be in [1, 150]");
  const std::string sources = "brake.sources=[{name: a, vehicle: 1}, {name: b, vehicle: -1, kind: remote, ";
  ExpectRefused({sources + "radio_lost_to_s: 9}]"}, "radio_lost_to_s needs radio_lost_from_s");
  ExpectRefused({sources + "radio_lost_from_s: 9, radio_lost_to_s: 9}]"},
                "radio_lost_to_s must be > radio_lost_from_s");
  ExpectRefused({"brake.equipment=[{from: 1, to: 2, valve: abc}]"}, "there is no \"abc\"");
  ExpectRefused({"brake.equipment=[{from: 1, to: 5}, {from: 5, to: 6}]"}, "vehicle 5 is in brake.equipment[0], too");
  ExpectRefused({"commands=[{time_s: 1, kind: apply, reduction_kpa: 100}, {time_s: 9, kind: apply, "
                 "reduction_kpa: 50}]"},
                "valves of direct release cannot let the brake down by steps");
  ExpectRefused({"train.consist[1].vehicle.length_m=40"}, "longer than 38.1 m");
}

TEST(Scenario, WarnsOfMixedReleases) {
  const auto loaded =
      config::LoadScenario(ScenarioFile("full_service_ab"),
                           {"brake.valves=[{name: ab, kind: direct_release}, {name: p, kind: graduated_release}]",
                            "brake.equipment=[{from: 3, to: 5, valve: p}]"});
  const auto tells = [&](const std::string& words) {
    return std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                       [&](const std::string& w) { return w.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(tells("147 valves of direct and 3 of graduated release"));
}

}  // namespace
}  // namespace train_dynamics
