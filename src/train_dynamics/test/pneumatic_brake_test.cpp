#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "published.h"

namespace train_dynamics {
namespace {

constexpr double kPsi = 6894.76;

BrakeCommand Apply(double time_s, double kpa) { return {time_s, BrakeCommandKind::kApply, kpa}; }
BrakeCommand Release(double time_s) { return {time_s, BrakeCommandKind::kRelease}; }
BrakeCommand Emergency(double time_s) { return {time_s, BrakeCommandKind::kEmergency}; }

// A train that is stepped by hand.
struct Train {
  Train(const PneumaticBrakeParams& params, int vehicles, double length_m)
      : brake(params, std::vector<double>(vehicles, length_m)) {}
  void Run(double to_s) { brake.PressuresAt(to_s, cylinder_pa); }
  int InEmergency() const {
    int count = 0;
    for (int i = 0; i < brake.vehicles(); ++i) count += brake.valve(i).Mode() == ControlValveMode::kEmergency;
    return count;
  }
  double Sum() const { return std::accumulate(cylinder_pa.begin(), cylinder_pa.end(), 0.0); }
  double Least() const { return *std::min_element(cylinder_pa.begin(), cylinder_pa.end()); }
  PneumaticBrake brake;
  std::vector<double> cylinder_pa;
};

PneumaticBrakeParams WithValve(ControlValveKind kind) {
  PneumaticBrakeParams params;
  params.valves[0].kind = kind;
  if (kind != ControlValveKind::kDirectRelease) params.valves[0].auxiliary_reservoir_l = 100.0;
  return params;
}

// One wagon in the driver's hand. The law is p0 2.5/3.5; the pipe's air in quick service adds 0.1 psi.
TEST(DirectRelease, EqualisesAsPublished) {
  const double charged[] = {70, 80, 90, 100}, reduction[] = {20, 23, 26, 29}, published[] = {50, 57, 64, 71};
  for (int i = 0; i < 4; ++i) {
    PneumaticBrakeParams params;
    params.charged_pressure_kpa = charged[i] * kPsi / 1e3;
    Train train(params, 1, 13.0);
    train.brake.Command(Apply(1.0, (reduction[i] + 3.0) * kPsi / 1e3));  // beyond full service
    train.Run(120.0);
    ExpectPublished("equalisation from " + std::to_string(static_cast<int>(charged[i])) + " psi [psi]",
                    train.cylinder_pa[0] / kPsi, published[i], 1.0 / published[i]);
    EXPECT_NEAR(train.cylinder_pa[0] / kPsi, charged[i] * 2.5 / 3.5, 0.2);
    EXPECT_EQ(train.InEmergency(), 0);
  }
}

TEST(DirectRelease, AnEmergencyHasBothReservoirs) {
  PneumaticBrakeParams params;
  params.charged_pressure_kpa = 90 * kPsi / 1e3;
  Train train(params, 1, 13.0);
  train.brake.Command(Emergency(1.0));
  train.Run(120.0);
  EXPECT_EQ(train.InEmergency(), 1);
  ExpectPublished("emergency from 90 psi [psi]", train.cylinder_pa[0] / kPsi, 90.0 * 6.0 / 7.0, 0.001);
}

// A reservoir at 79 psi and a pipe taken to 64 psi give 37.5 psi.
TEST(DirectRelease, AReservoirThatIsNotFullGivesLess) {
  PneumaticBrakeParams params;
  params.charged_pressure_kpa = 90 * kPsi / 1e3;
  params.initial_pressure_kpa = 79 * kPsi / 1e3;
  Train train(params, 1, 13.0);
  train.brake.Command(Apply(0.0, 26 * kPsi / 1e3));
  train.Run(120.0);
  ExpectPublished("re-application, reservoir 79 psi, pipe 64 psi [psi]", train.cylinder_pa[0] / kPsi, 37.5, 1.0 / 37.5);
}

TEST(DirectRelease, ASecondApplicationBeforeRechargeIsWeaker) {
  Train train(PneumaticBrakeParams{}, 60, 13.0);
  train.brake.Command(Apply(1.0, 100.0));
  train.Run(60.0);
  const double first = train.Sum();
  train.brake.Command(Release(60.0));
  train.brake.Command(Apply(70.0, 100.0));
  train.Run(130.0);
  EXPECT_LT(train.Sum(), 0.95 * first);
  // Recharged for ten minutes it is what it was.
  train.brake.Command(Release(130.0));
  train.brake.Command(Apply(730.0, 100.0));
  train.Run(789.0);
  EXPECT_NEAR(train.Sum() / first, 1.0, 0.01);
}

TEST(DirectRelease, ARetainerKeepsItsPressure) {
  PneumaticBrakeParams params;
  params.equipment.resize(3);
  for (int i = 0; i < 3; ++i) params.equipment[i].from = params.equipment[i].to = i + 1;
  params.equipment[0].retainer = Retainer::kHighPressure;
  params.equipment[1].retainer = Retainer::kLowPressure;
  params.equipment[2].retainer = Retainer::kSlowDirect;
  Train train(params, 4, 13.0);
  train.brake.Command(Apply(1.0, 170.0));
  train.brake.Command(Release(60.0));
  train.Run(120.0);
  EXPECT_NEAR(train.cylinder_pa[0] / kPsi, 20.0, 0.1);
  EXPECT_NEAR(train.cylinder_pa[1] / kPsi, 10.0, 0.1);
  EXPECT_GT(train.cylinder_pa[2], 5e3);  // 86 s [S]
  EXPECT_LT(train.cylinder_pa[3], 2e3);
  train.Run(60.0 + 86.0 + 10.0);  // and some for the wave and the charging
  EXPECT_NEAR(train.cylinder_pa[2], 0.0, 35e3);
}

// Speed of the emergency's wave from wagon 21 to 100, 13 m of pipe each, by the vents alone. The train has 20 wagons
// more, so that the closed tail reflects nothing.
double WaveSpeed(double threshold_kpa, double vent_mm, int cells) {
  PneumaticBrakeParams params;
  params.charged_pressure_kpa = 600.0 - 101.325;
  params.pipe.inner_diameter_mm = 32.0;
  params.pipe.length_ratio = 1.0;
  params.pipe.cells_per_vehicle = cells;
  params.valves[0].direct.quick_service_volume_l = 0.0;
  params.valves[0].direct.limiting_opening_mm = 0.0;
  params.valves[0].direct.quick_action_threshold_kpa = threshold_kpa;
  params.valves[0].direct.vent_opening_mm = vent_mm;
  Train train(params, 120, 13.0);
  train.brake.Command(Emergency(0.0));
  std::vector<double> fired(120, -1.0);
  for (double t = train.brake.step_s(); t < 12.0 && fired[99] < 0.0; t += train.brake.step_s()) {
    train.Run(t);
    for (int i = 0; i < 120; ++i) {
      const ControlValveState& s = train.brake.valve(i);
      if (fired[i] < 0.0 && s.Mode() == ControlValveMode::kEmergency) fired[i] = train.brake.time_s() - s.vent_open_s;
    }
  }
  return 79.0 * 13.0 / (fired[99] - fired[20]);
}

// An independent program has 267.3 m/s at 20 kPa and 207 m/s at 30 kPa with vents of 6.35 mm; no front may be faster
// than the speed lambda(d_em) of the characteristics, 268.1 and 262.9 m/s, + 1 % (at fine cells).
TEST(Emergency, ItsWaveIsNotFittedButComesFromTheVents) {
  ExpectPublished("emergency wave, 20 kPa, vents 6.35 mm, 64 cells [m/s]", WaveSpeed(20.0, 6.35, 64), 267.3, 0.01);
  ExpectPublished("emergency wave, 30 kPa, vents 6.35 mm, 32 cells [m/s]", WaveSpeed(30.0, 6.35, 32), 207.0, 0.02);
  EXPECT_LT(WaveSpeed(20.0, 10.0, 64), 268.1 * 1.01);
}

// A rack of 150 cars, vented at both ends: all cylinders full (99 %) after 16 s (2 s).
TEST(Emergency, ARackOf150CarsVentedAtBothEnds) {
  PneumaticBrakeParams params;
  params.charged_pressure_kpa = 90 * kPsi / 1e3;
  PipeSourceParams rear;
  rear.kind = PipeSourceKind::kRemote;
  rear.vehicle = -1;
  params.sources.push_back(rear);
  Train train(params, 150, 15.2);
  train.brake.Command(Emergency(0.0));
  double full_s = 0.0;
  for (double t = 0.1; t < 30.0 && full_s == 0.0; t += 0.1) {
    train.Run(t);
    if (train.Least() > 0.99 * 90.0 * kPsi * 6.0 / 7.0) full_s = t;
  }
  ExpectPublished("rack of 150 cars, vented at both ends: all full (99 %) [s]; opening fitted to it", full_s, 16.0,
                  2.0 / 16.0);
}

TEST(Emergency, NothingButItsReleaseAfterTheBlockingTimeEndsIt) {
  Train train(PneumaticBrakeParams{}, 10, 13.0);
  train.brake.Command(Emergency(1.0));
  train.brake.Command(Apply(10.0, 50.0));
  train.brake.Command(Release(30.0));
  train.Run(100.0);
  EXPECT_EQ(train.InEmergency(), 10);
  train.brake.Command(Release(100.0));
  train.Run(400.0);
  EXPECT_EQ(train.InEmergency(), 0);
  EXPECT_LT(train.cylinder_pa[9], 1e3);
}

// The air of cylinders and auxiliary reservoirs helps to charge the pipe: the tail lets go earlier.
TEST(Emergency, AnAcceleratedReleaseGivesItsAirToThePipe) {
  double released_s[2];
  for (bool accelerated : {false, true}) {
    PneumaticBrakeParams params;
    params.valves[0].direct.accelerated_release = accelerated;
    Train train(params, 60, 13.0);
    const double before = train.brake.AirMass();
    train.brake.Command(Emergency(1.0));
    train.brake.Command(Release(70.0));
    train.Run(70.0);
    EXPECT_EQ(train.InEmergency(), 60);
    released_s[accelerated] = 70.0;
    while (train.InEmergency() > 0 && released_s[accelerated] < 400.0) train.Run(released_s[accelerated] += 0.5);
    EXPECT_NEAR((train.brake.AirMass() + train.brake.ReleasedMass() - train.brake.SuppliedMass()) / before, 1.0, 1e-9);
  }
  EXPECT_LT(released_s[1], 0.9 * released_s[0]);
}

// A lapped cylinder that leaks 10 kPa a minute has 10 kPa less after it; the limiting valve keeps 70 kPa in it.
TEST(DirectRelease, ACylinderThatLeaks) {
  for (bool limiting : {false, true}) {
    PneumaticBrakeParams params;
    params.valves[0].cylinder_leakage_kpa_per_min = 10.0;
    if (!limiting) params.valves[0].direct.limiting_opening_mm = 0.0;
    Train train(params, 1, 13.0);
    train.brake.Command(Apply(1.0, 60.0));
    train.Run(60.0);
    const double applied = train.cylinder_pa[0];
    train.Run(120.0);
    EXPECT_NEAR(applied - train.cylinder_pa[0], 10e3, 0.1e3);
    train.Run(1200.0);
    EXPECT_NEAR(train.cylinder_pa[0], limiting ? 70e3 : 0.0, 1e3);
  }
}

// Times of a distributor with one vehicle: P 3 to 5 s and 15 to 20 s, G 18 to 30 s and 45 to 60 s.
TEST(GraduatedRelease, FillsAndReleasesInItsTimes) {
  for (bool goods : {false, true}) {
    PneumaticBrakeParams params = WithValve(ControlValveKind::kGraduatedRelease);
    params.charged_pressure_kpa = 500.0;
    if (goods) {
      params.valves[0].graduated.fill_time_s = 24.0;
      params.valves[0].graduated.release_time_s = 52.5;
    }
    Train train(params, 1, 13.0);
    train.brake.Command(Emergency(1.0));
    double full_s = 0.0, first_s = 0.0, released_s = 0.0;
    for (double t = 1.0; t < 80.0; t += 0.05) {
      train.Run(t);
      if (first_s == 0.0 && train.cylinder_pa[0] >= 38e3) first_s = t - 1.0;
      if (full_s == 0.0 && train.cylinder_pa[0] >= 0.95 * 380e3) full_s = t - 1.0;
    }
    EXPECT_NEAR(train.cylinder_pa[0], 380e3, 1e3);
    EXPECT_LT(first_s, 1.3);  // 10 % within 1 s of the pipe's fall
    EXPECT_GT(full_s, goods ? 18.0 : 3.0);
    EXPECT_LT(full_s, goods ? 30.0 : 5.0);
    // Released from full service: a pipe that comes from nothing takes seconds of its own.
    Train service(params, 1, 13.0);
    service.brake.Command(Apply(1.0, 160.0));
    service.brake.Command(Release(80.0));
    for (double t = 80.0; t < 200.0; t += 0.05) {
      service.Run(t);
      if (released_s == 0.0 && service.cylinder_pa[0] <= 40e3) released_s = t - 80.0;
    }
    EXPECT_GT(released_s, goods ? 45.0 : 15.0);
    EXPECT_LT(released_s, goods ? 60.0 : 20.0);
  }
}

TEST(GraduatedRelease, FollowsThePipeUpAndDown) {
  PneumaticBrakeParams params = WithValve(ControlValveKind::kGraduatedRelease);
  params.charged_pressure_kpa = 500.0;
  Train train(params, 20, 13.0);
  train.brake.Command(Apply(1.0, 150.0));
  train.Run(60.0);
  for (double p : train.cylinder_pa) EXPECT_NEAR(p, 380e3, 4e3);
  train.brake.Command(Apply(60.0, 75.0));
  train.Run(160.0);
  for (double p : train.cylinder_pa) EXPECT_NEAR(p, 190e3, 4e3);
  // The same hand on direct release lets the brake go.
  Train direct(PneumaticBrakeParams{}, 20, 13.0);
  direct.brake.Command(Apply(1.0, 150.0));
  direct.brake.Command(Apply(60.0, 75.0));
  direct.Run(160.0);
  for (double p : direct.cylinder_pa) EXPECT_LT(p, 1e3);
}

// 0.5 kPa/s applies nothing (overcharge decays), 10 kPa/s does.
TEST(GraduatedRelease, IsInsensitiveToASlowFall) {
  PneumaticBrakeParams params = WithValve(ControlValveKind::kGraduatedRelease);
  params.charged_pressure_kpa = 500.0;
  params.drivers_valve.overcharge_kpa = 40.0;
  params.drivers_valve.overcharge_time_s = 40.0;
  params.drivers_valve.overcharge_decay_kpa_per_s = 0.5;
  Train train(params, 20, 13.0);
  train.brake.Command(Release(1.0));
  double most = 0.0, highest = 0.0;
  for (double t = 1.0; t < 200.0; t += 0.5) {
    train.Run(t);
    most = std::max(most, *std::max_element(train.cylinder_pa.begin(), train.cylinder_pa.end()));
    highest = std::max(highest, train.brake.TailPressure());
  }
  EXPECT_EQ(most, 0.0);
  EXPECT_NEAR(highest, 540e3, 2e3);
  EXPECT_NEAR(train.brake.TailPressure(), 500e3, 2e3);
}

// 100 cars of 60 ft: at 10 s an ECP train's brake force is 1.45 times that of one with a head-end emergency.
TEST(Ecp, BuildsUpBeforeAHeadEndEmergency) {
  Train ecp(WithValve(ControlValveKind::kEcp), 100, 18.29), head(PneumaticBrakeParams{}, 100, 18.29);
  ecp.brake.Command(Emergency(0.0));
  head.brake.Command(Emergency(0.0));
  ecp.Run(120.0), head.Run(120.0);
  const double ecp_full = ecp.Sum(), head_full = head.Sum();
  Train ecp2(WithValve(ControlValveKind::kEcp), 100, 18.29), head2(PneumaticBrakeParams{}, 100, 18.29);
  ecp2.brake.Command(Emergency(0.0));
  head2.brake.Command(Emergency(0.0));
  ecp2.Run(10.0), head2.Run(10.0);
  const double ratio = (ecp2.Sum() / ecp_full) / (head2.Sum() / head_full);
  ExpectPublished("ECP against head end, brake force at 10 s [-]", ratio, 1.45, 0.07 / 1.45);
}

TEST(Ecp, ThePipeStaysChargedInService) {
  Train train(WithValve(ControlValveKind::kEcp), 50, 13.0);
  train.brake.Command(Apply(1.0, 85.0));
  train.Run(40.0);
  EXPECT_GT(train.brake.TailPressure(), 570e3);  // it only refills reservoirs
  for (double p : train.cylinder_pa) EXPECT_NEAR(p, 215e3, 1e3);
}

TEST(EpAssistance, HastensTheTail) {
  PneumaticBrakeParams params;
  Train pneumatic(params, 100, 13.0);
  params.valves[0].ep_vent_opening_mm = 1.6;
  Train assisted(params, 100, 13.0);
  for (Train* train : {&pneumatic, &assisted}) {
    train->brake.Command(Apply(0.0, 100.0));
    train->Run(10.0);
  }
  EXPECT_GT(assisted.cylinder_pa[99], 2.0 * pneumatic.cylinder_pa[99]);
  EXPECT_EQ(assisted.InEmergency(), 0);
}

// Air in pipe, reservoirs and cylinders, with what came in and what went out.
TEST(PneumaticBrake, KeepsTheMassOfAir) {
  for (ControlValveKind kind :
       {ControlValveKind::kDirectRelease, ControlValveKind::kGraduatedRelease, ControlValveKind::kEcp}) {
    PneumaticBrakeParams params = WithValve(kind);
    params.pipe.leakage_g_per_s_km = 5.0;
    params.valves[0].cylinder_leakage_kpa_per_min = 10.0;
    params.parted_hoses.push_back({20, 100.0});
    Train train(params, 40, 13.0);
    const double before = train.brake.AirMass();
    train.brake.Command(Apply(1.0, 70.0));
    train.brake.Command(Release(40.0));
    train.brake.Command(Apply(60.0, 120.0));
    train.Run(160.0);
    EXPECT_GT(train.brake.SuppliedMass(), 0.01 * before);
    EXPECT_GT(train.brake.ReleasedMass(), 0.1 * before);
    EXPECT_NEAR((train.brake.AirMass() + train.brake.ReleasedMass() - train.brake.SuppliedMass()) / before, 1.0, 1e-9);
  }
}

TEST(PneumaticBrake, APartedHoseIsAnEmergencyOfBothParts) {
  Train train(PneumaticBrakeParams{}, 60, 13.0);
  train.Run(5.0);
  train.brake.OpenPipe(5.0, 29);
  train.Run(12.0);
  EXPECT_EQ(train.InEmergency(), 60);
  train.Run(60.0);
  for (double p : train.cylinder_pa) EXPECT_NEAR(p, 600e3 * 6.0 / 7.0, 3e3);
}

TEST(PneumaticBrake, BehindAClosedAngleCockNothingArrives) {
  PneumaticBrakeParams params;
  params.closed_angle_cocks = {20};
  Train train(params, 40, 13.0);
  train.brake.Command(Emergency(1.0));
  train.Run(30.0);
  EXPECT_EQ(train.InEmergency(), 20);
  for (int i = 20; i < 40; ++i) EXPECT_EQ(train.cylinder_pa[i], 0.0);
}

TEST(PneumaticBrake, ATwoWayEndOfTrainDeviceVentsTheTail) {
  for (bool two_way : {false, true}) {
    PneumaticBrakeParams params;
    PipeSourceParams device;
    device.kind = PipeSourceKind::kEndOfTrain;
    device.vehicle = -1;
    device.radio_delay_s = 1.0;
    device.two_way = two_way;
    params.sources.push_back(device);
    Train train(params, 100, 13.0);
    train.brake.Command(Emergency(0.0));
    train.Run(1.5);
    EXPECT_EQ(train.brake.valve(99).Mode() == ControlValveMode::kEmergency, two_way);
  }
}

TEST(PneumaticBrake, ARemoteLocomotiveThatHearsNothingFeedsAgainstTheDriver) {
  PneumaticBrakeParams params;
  PipeSourceParams remote;
  remote.kind = PipeSourceKind::kRemote;
  remote.vehicle = 51;
  remote.radio_delay_s = 1.0;
  params.sources.push_back(remote);
  Train heard(params, 100, 13.0);
  params.sources[1].radio_lost_from_s = 0.0;
  Train lost(params, 100, 13.0);
  for (Train* train : {&heard, &lost}) {
    train->brake.Command(Apply(1.0, 100.0));
    train->Run(40.0);
  }
  EXPECT_LT(heard.brake.PipePressure(50), 510e3);
  EXPECT_GT(lost.brake.PipePressure(50), 560e3);
  lost.Run(300.0);  // its valve has lapped 45 s after the loss
  EXPECT_LT(lost.brake.PipePressure(50), 515e3);
}

// Independent commands: the remote locomotive does what it has been told, whatever the driver does.
TEST(PneumaticBrake, ARemoteLocomotiveMayHaveCommandsOfItsOwn) {
  PneumaticBrakeParams params;
  PipeSourceParams remote;
  remote.kind = PipeSourceKind::kRemote;
  remote.vehicle = -1;
  remote.radio_delay_s = 1.0;
  remote.commands = {Apply(5.0, 80.0), Release(60.0)};
  params.sources.push_back(remote);
  Train train(params, 20, 13.0);
  train.Run(5.9);
  EXPECT_NEAR(train.brake.TailPressure(), 600e3, 1e3);
  train.brake.Command(Apply(5.9, 120.0));
  train.Run(50.0);
  EXPECT_EQ(train.brake.source(0).equalising_pa, 480e3);
  EXPECT_EQ(train.brake.source(1).equalising_pa, 520e3);
  EXPECT_GT(train.brake.TailPressure(), train.brake.HeadPressure() + 10e3);  // it feeds against the driver
  train.Run(70.0);
  EXPECT_EQ(train.brake.source(1).equalising_pa, 600e3);
  EXPECT_EQ(train.brake.source(0).equalising_pa, 480e3);
}

TEST(PneumaticBrake, EquipmentActsWhereItIs) {
  PneumaticBrakeParams params;
  params.equipment.resize(3);
  params.equipment[0].from = params.equipment[0].to = 2;
  params.equipment[0].cut_out = true;
  params.equipment[1].from = params.equipment[1].to = 3;
  params.equipment[1].empty_load = EmptyLoad::kTwoStep;
  params.equipment[1].load_share = 0.0;
  params.equipment[2].from = params.equipment[2].to = 4;
  params.equipment[2].empty_load = EmptyLoad::kProportional;
  params.equipment[2].load_share = 0.5;
  Train train(params, 5, 13.0);
  train.brake.Command(Apply(1.0, 170.0));
  train.Run(60.0);
  EXPECT_EQ(train.cylinder_pa[1], 0.0);
  EXPECT_NEAR(train.cylinder_pa[2] / train.cylinder_pa[0], 0.5, 0.01);
  EXPECT_NEAR(train.cylinder_pa[3] / train.cylinder_pa[0], 0.75, 0.01);
}

// Whatever is asked for in between, and after its state went through a list of numbers in the middle of a wave.
TEST(PneumaticBrake, ItsStateIsItsListOfFields) {
  Train whole(PneumaticBrakeParams{}, 50, 13.0), first(PneumaticBrakeParams{}, 50, 13.0),
      second(PneumaticBrakeParams{}, 50, 13.0);
  whole.brake.Command(Apply(1.0, 70.0));
  first.brake.Command(Apply(1.0, 70.0));
  for (double t = 0.0; t < 3.0; t += 0.0007) first.Run(t);
  whole.Run(2.0), whole.Run(3.0), first.Run(3.0);
  std::vector<double> numbers;
  first.brake.ForEachField([&](double x) { numbers.push_back(x); });
  std::size_t at = 0;
  second.brake.ForEachField([&](double& x) { x = numbers[at++]; });
  EXPECT_EQ(at, numbers.size());
  whole.Run(20.0), second.Run(20.0);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(whole.cylinder_pa[i], second.cylinder_pa[i]);
  EXPECT_GT(whole.cylinder_pa[49], 50e3);
}

// Mean difference [Pa] of the cylinders' pressures of a service application over the train from those of the last.
std::vector<double> Errors(const std::vector<PneumaticBrakeParams>& variants) {
  std::vector<std::vector<double>> pressures;
  for (const PneumaticBrakeParams& params : variants) {
    Train train(params, 100, 10.5);
    train.brake.Command(Apply(0.0, 100.0));
    pressures.emplace_back();
    for (double t : {5.0, 10.0, 20.0, 40.0}) {
      train.Run(t);
      for (double p : train.cylinder_pa) pressures.back().push_back(p);
    }
  }
  std::vector<double> errors;
  for (const std::vector<double>& p : pressures) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(p[i] - pressures.back()[i]);
    errors.push_back(sum / static_cast<double>(p.size()));
  }
  errors.pop_back();
  return errors;
}

TEST(PneumaticBrake, ConvergesInSteps) {
  std::vector<PneumaticBrakeParams> variants(5);
  double step_ms = 5.0;
  for (PneumaticBrakeParams& params : variants) {
    params.pipe.longest_step_ms = step_ms;
    step_ms *= 0.5;
  }
  const std::vector<double> errors = Errors(variants);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::printf("steps of %g ms: %.3f kPa\n", 5.0 / (1 << i), 1e-3 * errors[i]);
    if (i > 0) {
      EXPECT_LT(errors[i], 0.7 * errors[i - 1]);
    }
  }
  EXPECT_LT(errors[0], 2e3);
}

TEST(PneumaticBrake, ConvergesInCells) {
  std::vector<PneumaticBrakeParams> variants(5);
  for (int i = 0; i < 5; ++i) variants[i].pipe.cells_per_vehicle = 1 << i;
  const std::vector<double> errors = Errors(variants);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::printf("%d cells: %.3f kPa\n", 1 << i, 1e-3 * errors[i]);
    if (i > 0) {
      EXPECT_LT(errors[i], 0.8 * errors[i - 1]);
    }
  }
  EXPECT_LT(errors[1], 3e3);  // two are enough
}

// No emergency part may fire in service, release or recharge, at any cell count: a seeded search.
TEST(PneumaticBrake, NoServiceCommandIsAnEmergency) {
  std::mt19937 random(17);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 5) / static_cast<double>(1 << 27);
  };
  int applied = 0;
  for (int trial = 0; trial < 40; ++trial) {
    PneumaticBrakeParams params;
    params.pipe.cells_per_vehicle = 1 << (trial % 4);
    params.charged_pressure_kpa = uniform(450.0, 700.0);
    params.drivers_valve.overcharge_kpa = trial % 3 == 0 ? 40.0 : 0.0;
    params.pipe.leakage_g_per_s_km = trial % 5 == 0 ? 10.0 : 0.0;
    const int vehicles = static_cast<int>(uniform(1.0, 160.0));
    if (trial % 4 == 1 && vehicles > 3) {
      PipeSourceParams remote;
      remote.kind = PipeSourceKind::kRemote;
      remote.vehicle = vehicles / 2;
      remote.radio_delay_s = uniform(0.0, 3.0);
      params.sources.push_back(remote);
    }
    Train train(params, vehicles, uniform(10.0, 26.0));
    double t = 0.0;
    for (int command = 0; command < 6; ++command) {
      t += uniform(0.1, 25.0);
      train.Run(t);
      train.brake.Command(uniform(0.0, 1.0) < 0.4 ? Release(t) : Apply(t, uniform(15.0, 200.0)));
    }
    train.Run(t + 30.0);
    applied += train.Sum() > 0.0;
    EXPECT_EQ(train.InEmergency(), 0) << "trial " << trial << ", vehicles " << vehicles << ", cells "
                                      << params.pipe.cells_per_vehicle;
  }
  EXPECT_GT(applied, 20);
}

}  // namespace
}  // namespace train_dynamics
