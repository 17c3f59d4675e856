// What a driver sees: the line ahead by hand-made tables, the train by its records, and the same after a checkpoint.
#include "train_dynamics/train/driver_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "simulate.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

DriverCommand Brake(DriverCommandKind kind, double reduction_kpa = 50.0) {
  DriverCommand command;
  command.kind = kind;
  command.reduction_kpa = reduction_kpa;
  return command;
}

DriverCommand Timed(double time_s, DriverCommand command) {
  command.time_s = time_s;
  return command;
}

TEST(RouteSight, ShowsTheLineFromTheFrontOn) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("emergency"), {"train.consist[0].count=2"});
  TrainParams two = loaded.params.train;
  two.consist.resize(1);
  two.consist[0].count = 2;
  two.consist[0].vehicles_per_unit = 1;
  const Consist consist(two);
  const double length_m = consist.vehicle(0).length_m, pitch_m = -consist.centre_m[1];
  TrackParams track;
  track.speed_limits = {{0.0, 72.0}, {500.0, 36.0}, {600.0, 54.0}, {2000.0, 90.0}};
  track.grades = {{0.0, 0.1}, {0.5 * pitch_m, 0.3}, {1000.0, -0.2}};
  track.stations = {{"Behind", -10.0}, {"Here", 0.0}, {"Next", 700.0}, {"Far", 5000.0}};
  const RouteSight sight(track, consist, -50.0);
  DriverView view;
  sight.Look({50.0, 50.0}, 1500.0, view);
  EXPECT_DOUBLE_EQ(view.position_m, 0.0);
  EXPECT_DOUBLE_EQ(view.front_m, 0.5 * length_m);
  EXPECT_DOUBLE_EQ(view.rear_m, -pitch_m - 0.5 * length_m);
  EXPECT_DOUBLE_EQ(view.speed_limit_mps, 20.0);
  EXPECT_DOUBLE_EQ(view.mean_grade, 0.001);
  ASSERT_EQ(view.limits_ahead.size(), 2u);
  EXPECT_EQ(view.limits_ahead[0].from_m, 500.0);
  EXPECT_DOUBLE_EQ(view.limits_ahead[0].value, 10.0);
  EXPECT_DOUBLE_EQ(view.limits_ahead[1].value, 15.0);
  ASSERT_EQ(view.stations_ahead.size(), 2u);
  EXPECT_EQ(view.stations_ahead[0].name, "Here");
  EXPECT_EQ(view.stations_ahead[1].name, "Next");
  // The first vehicle on 3 permille, the other on 1; the low limit holds until the rear has left it.
  sight.Look({50.0 + 600.0 + pitch_m, 50.0 + 600.0 + pitch_m}, 100.0, view);
  EXPECT_DOUBLE_EQ(view.speed_limit_mps, 10.0);
  sight.Look({50.0 + pitch_m, 50.0 + pitch_m}, 100.0, view);
  EXPECT_DOUBLE_EQ(view.mean_grade, 0.002);
  EXPECT_TRUE(view.limits_ahead.empty());
}

TEST(RouteSight, WithoutLimitsThereIsNone) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("emergency"), {});
  const RouteSight sight({}, loaded.consist, 0.0);
  DriverView view;
  sight.Look(std::vector<double>(loaded.consist.vehicles(), 0.0), 1e6, view);
  EXPECT_EQ(view.speed_limit_mps, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(view.limits_ahead.empty() && view.grades_ahead.empty() && view.stations_ahead.empty());
}

TEST(BrakeHandle, StandsWhereTheNewestCommandHasPutIt) {
  const std::vector<DriverCommand> commands = {Timed(1.0, Brake(DriverCommandKind::kApply, 50.0)),
                                               Timed(8.0, Brake(DriverCommandKind::kRelease)),
                                               Timed(20.0, Brake(DriverCommandKind::kEmergency))};
  const std::vector<GivenCommand> given = {{30, Brake(DriverCommandKind::kApply, 80.0), true},
                                           {250, Brake(DriverCommandKind::kApply, 90.0), true}};
  DriverView view;
  const auto at = [&](double time_s) {
    SetBrakeHandle(0.0, commands, given, time_s, 0.1, view);
    return view.reduction_kpa;
  };
  EXPECT_EQ(at(0.9), 0.0);
  EXPECT_EQ(at(1.0), 50.0);
  EXPECT_EQ(at(5.0), 80.0);
  EXPECT_EQ(at(9.0), 0.0);
  EXPECT_FALSE(view.emergency);
  EXPECT_EQ(at(26.0), 0.0);  // an emergency goes on: it is not the 90 kPa of the apply after it
  EXPECT_TRUE(view.emergency);
}

/// A short train that is driven by a list, and what its driver sees every half second, before each of its commands.
struct DrivenTrain {
  DrivenTrain()
      : loaded(config::LoadScenario(ScenarioFile("drive_and_stop"),
                                    {"commands=[]", "until=null", "duration_s=8", "record_interval_s=1"})),
        transport(loaded.params, loaded.consist, 1),
        master(loaded.params, loaded.consist, transport, loaded.pressures) {}
  void Exchange() {
    if (master.exchange() % 500 == 0) seen.push_back(master.View(5000.0, true));
    if (master.exchange() == 500) {
      DriverCommand command = Brake(DriverCommandKind::kThrottle);
      command.notch = 8.0;
      master.Command(command);
    }
    if (master.exchange() == 6500) master.Command(Brake(DriverCommandKind::kApply, 70.0));
    master.Exchange();
  }
  config::LoadedScenario loaded;
  InProcessTransport transport;
  TrainMaster master;
  std::vector<DriverView> seen;
};

TEST(DriverView, ShowsWhatTheTrainDoes) {
  DrivenTrain train;
  train.master.Start();
  while (!train.master.Done()) train.Exchange();
  ASSERT_EQ(train.seen.size(), 16u);
  for (std::size_t i = 0; i < train.seen.size(); ++i) EXPECT_EQ(train.seen[i].exchange, 500 * i);
  EXPECT_EQ(train.seen[1].throttle_notch, 0.0);
  EXPECT_EQ(train.seen[2].throttle_notch, 8.0);
  EXPECT_GT(train.seen[8].effort_n, 0.0);
  EXPECT_GT(train.seen[8].speed_mps, 0.0);
  EXPECT_GT(train.seen[8].position_m, train.seen[0].position_m);
  EXPECT_TRUE(std::isnan(train.seen[8].brake_pipe_kpa));  // an empirical brake has no pipe
  EXPECT_EQ(train.seen[8].coupler_force_n.size(), 10u);
  EXPECT_GT(train.seen[8].coupler_force_n[0],
            train.seen[8].coupler_force_n[9]);  // the locomotive pulls them all
  EXPECT_EQ(train.seen[13].reduction_kpa, 0.0);
  EXPECT_EQ(train.seen[14].reduction_kpa, 70.0);
  EXPECT_GT(train.seen[15].cylinder_kpa, train.seen[14].cylinder_kpa);
}

TEST(DriverView, LookingChangesNothing) {
  DrivenTrain watched, unwatched;
  watched.master.Start();
  unwatched.master.Start();
  while (!watched.master.Done()) watched.Exchange();
  while (!unwatched.master.Done()) {
    DriverCommand throttle = Brake(DriverCommandKind::kThrottle);
    throttle.notch = 8.0;
    if (unwatched.master.exchange() == 500) unwatched.master.Command(throttle);
    if (unwatched.master.exchange() == 6500) unwatched.master.Command(Brake(DriverCommandKind::kApply, 70.0));
    unwatched.master.Exchange();
  }
  EXPECT_EQ(watched.master.state_digest(), unwatched.master.state_digest());
}

TEST(DriverView, IsTheSameAfterACheckpoint) {
  DrivenTrain whole;
  whole.master.Start();
  TrainCheckpoint checkpoint;
  while (!whole.master.Done()) {
    const bool asks = whole.master.exchange() + 1 == 7000;
    if (asks) whole.master.AskForCheckpoint();
    whole.Exchange();
    if (asks) checkpoint = whole.master.Checkpoint();
  }
  DrivenTrain rest;
  rest.master.Resume(checkpoint);
  while (!rest.master.Done()) rest.Exchange();
  EXPECT_EQ(rest.master.state_digest(), whole.master.state_digest());
  ASSERT_EQ(rest.seen.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const DriverView &a = rest.seen[i], &b = whole.seen[14 + i];
    EXPECT_EQ(a.exchange, b.exchange);
    EXPECT_EQ(a.position_m, b.position_m);
    EXPECT_EQ(a.speed_mps, b.speed_mps);
    EXPECT_EQ(a.effort_n, b.effort_n);
    EXPECT_EQ(a.throttle_notch, b.throttle_notch);
    EXPECT_EQ(a.reduction_kpa, b.reduction_kpa);
    EXPECT_EQ(a.cylinder_kpa, b.cylinder_kpa);
    EXPECT_EQ(a.mean_cylinder_kpa, b.mean_cylinder_kpa);
    EXPECT_EQ(a.coupler_force_n, b.coupler_force_n);
  }
}

}  // namespace
}  // namespace train_dynamics
