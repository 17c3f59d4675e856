#include "train_dynamics/train/command_schedule.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simulate.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

DriverCommand Conditional(const ConditionParams& when, DriverCommandKind kind = DriverCommandKind::kEmergency) {
  DriverCommand command;
  command.kind = kind;
  command.when = when;
  return command;
}

/// The exchanges at which commands are given to a train that moves so: position and speed at each exchange of 1 s.
std::vector<std::uint64_t> GivenAt(CommandSchedule& schedule, const std::vector<std::pair<double, double>>& motion) {
  std::vector<std::uint64_t> at;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    std::vector<GivenCommand> given;
    schedule.Judge({i, static_cast<double>(i), motion[i].first, motion[i].second}, given);
    for (const GivenCommand& one : given) at.push_back(one.exchange);
  }
  return at;
}

ConditionParams At(double position_m) {
  ConditionParams condition;
  condition.position_m = position_m;
  return condition;
}

TEST(CommandSchedule, APlaceIsReachedFromEitherSide) {
  CommandSchedule forward({Conditional(At(20.0))}, std::nullopt);
  EXPECT_EQ(GivenAt(forward, {{0, 15}, {15, 15}, {30, 15}, {10, -15}}), (std::vector<std::uint64_t>{2}));
  CommandSchedule backward({Conditional(At(20.0))}, std::nullopt);
  EXPECT_EQ(GivenAt(backward, {{30, -5}, {25, -5}, {20, -5}, {15, -5}}), (std::vector<std::uint64_t>{2}));
}

TEST(CommandSchedule, SpeedsAreMagnitudesAndTheDelayCountsFromTheFirstTime) {
  ConditionParams slow;
  slow.speed_below_kmh = 36.0;
  slow.delay_s = 2.0;
  CommandSchedule schedule({Conditional(slow)}, std::nullopt);
  EXPECT_EQ(GivenAt(schedule, {{0, -20}, {0, -10}, {0, -9.9}, {0, -20}, {0, -20}}), (std::vector<std::uint64_t>{4}));
  ConditionParams fast;
  fast.speed_above_kmh = 36.0;
  CommandSchedule other({Conditional(fast)}, std::nullopt);
  EXPECT_EQ(GivenAt(other, {{0, 9}, {0, 10}, {0, -10.1}}), (std::vector<std::uint64_t>{2}));
}

TEST(CommandSchedule, StandingIsSeenAtAChangeOfSign) {
  ConditionParams standing;
  standing.standing = true;
  CommandSchedule schedule({Conditional(standing)}, std::nullopt);
  EXPECT_EQ(GivenAt(schedule, {{0, 1}, {1, 0.1}, {1, -0.1}, {1, -0.2}}), (std::vector<std::uint64_t>{2}));
}

TEST(CommandSchedule, TheListIsReadAsAnInstruction) {
  // The second place lies before the first: it is watched for only after the first was passed, on the way back.
  CommandSchedule schedule({Conditional(At(20.0)), Conditional(At(10.0), DriverCommandKind::kRelease)}, std::nullopt);
  EXPECT_EQ(GivenAt(schedule, {{0, 5}, {15, 5}, {25, 5}, {15, -5}, {5, -5}}), (std::vector<std::uint64_t>{2, 4}));
  DriverCommand timed;
  timed.kind = DriverCommandKind::kRelease;
  timed.time_s = 3.0;
  CommandSchedule later({timed, Conditional(At(20.0))}, std::nullopt);
  EXPECT_EQ(GivenAt(later, {{0, 5}, {15, 5}, {25, 5}, {30, 5}, {15, -5}}), (std::vector<std::uint64_t>{4}));
}

TEST(CommandSchedule, TheEndAtStandstillNeedsATrainThatHasMoved) {
  ConditionParams standing;
  standing.standing = true;
  CommandSchedule schedule({}, standing);
  const std::vector<std::pair<double, bool>> speeds = {{0.0, false}, {0.5, false}, {0.01, false}, {0.0005, true}};
  std::vector<GivenCommand> given;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    schedule.Judge({i, static_cast<double>(i), 0.0, speeds[i].first}, given);
    EXPECT_EQ(schedule.EndIsReached(), speeds[i].second) << i;
  }
  EXPECT_TRUE(given.empty());
}

TEST(CommandSchedule, ItsMemoryGoesOn) {
  ConditionParams slow;
  slow.speed_below_kmh = 36.0;
  slow.delay_s = 2.0;
  const std::vector<DriverCommand> commands = {Conditional(slow), Conditional(At(100.0))};
  DriverCommand live;
  live.kind = DriverCommandKind::kDynamicBrake;
  live.notch = 4.0;
  live.vehicles = {1, -1};
  CommandSchedule whole(commands, At(200.0));
  std::vector<GivenCommand> given;
  whole.Add(live);
  whole.Judge({0, 0.0, 0.0, 9.0}, given);
  CommandSchedule resumed(commands, At(200.0));
  resumed.SetMemory(whole.Memory());
  ASSERT_EQ(resumed.Given().size(), 1u);
  EXPECT_TRUE(resumed.Given()[0].is_live);
  EXPECT_EQ(resumed.Given()[0].command.Text(), "dynamic_brake 4");
  EXPECT_EQ(resumed.Given()[0].command.vehicles, (std::vector<int>{1, -1}));
  for (CommandSchedule* schedule : {&whole, &resumed}) {
    std::vector<GivenCommand> later;
    for (std::uint64_t i = 1; i < 30; ++i)
      schedule->Judge({i, static_cast<double>(i), 10.0 * static_cast<double>(i), 9.0}, later);
    ASSERT_EQ(later.size(), 2u);
    EXPECT_EQ(later[0].exchange, 2u);
    EXPECT_EQ(later[1].exchange, 10u);
    EXPECT_TRUE(schedule->EndIsReached());
  }
  EXPECT_THROW(CommandSchedule({}, std::nullopt).SetMemory(whole.Memory()), SnapshotError);
}

/// A short train under commands; live ones at given exchanges.
struct Driven {
  explicit Driven(const std::vector<std::string>& more, const std::string& commands, int threads = 1)
      : scenario(config::LoadScenario(ScenarioFile("emergency"), Overrides(more, commands))),
        vehicles(scenario.params, scenario.consist, threads),
        master(scenario.params, scenario.consist, vehicles, scenario.pressures) {
    master.AddObserver([this](const TrainRecord& record) { last = record; });
  }
  static std::vector<std::string> Overrides(const std::vector<std::string>& more, const std::string& commands) {
    std::vector<std::string> overrides = {"model=ltd",
                                          "brake=single_vehicle",
                                          "duration_s=30",
                                          "initial_speed_kmh=20",
                                          "train.consist[1].count=4",
                                          "train.consist[3].count=4",
                                          "detail_vehicles=[]",
                                          "commands=" + commands};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return overrides;
  }
  void RunUntil(std::uint64_t exchange) {
    while (!master.Done() && master.exchange() < exchange) master.Exchange();
  }

  config::LoadedScenario scenario;
  InProcessTransport vehicles;
  TrainMaster master;
  TrainRecord last;
};

DriverCommand Apply(double reduction_kpa) {
  DriverCommand command;
  command.kind = DriverCommandKind::kApply;
  command.reduction_kpa = reduction_kpa;
  return command;
}

TEST(LiveCommands, AreRepeatedToTheBitAsCommandsOfExchanges) {
  Driven live({}, "[{time_s: 1, kind: apply, reduction_kpa: 50}]");
  live.master.Start();
  live.RunUntil(2345);
  live.master.Command(Apply(100.0));
  live.RunUntil(9003);
  DriverCommand release;
  release.kind = DriverCommandKind::kRelease;
  live.master.Command(release);
  live.RunUntil(30000);
  const std::string list =
      "[{time_s: 1, kind: apply, reduction_kpa: 50}, {exchange: 2345, kind: apply, reduction_kpa: 100}, "
      "{exchange: 9003, kind: release}]";
  Driven repeated({}, list);
  repeated.master.Start();
  repeated.RunUntil(30000);
  EXPECT_EQ(live.master.state_digest(), repeated.master.state_digest());
  Driven later({},
               "[{time_s: 1, kind: apply, reduction_kpa: 50}, {exchange: 2346, kind: apply, reduction_kpa: 100}, "
               "{exchange: 9003, kind: release}]");
  later.master.Start();
  later.RunUntil(30000);
  EXPECT_NE(live.master.state_digest(), later.master.state_digest());
}

TEST(LiveCommands, GoOnFromACheckpoint) {
  Driven live({}, "[]");
  live.master.Start();
  live.RunUntil(2345);
  live.master.Command(Apply(100.0));
  live.RunUntil(3999);
  live.master.AskForCheckpoint();
  live.RunUntil(4000);
  const TrainCheckpoint checkpoint = live.master.Checkpoint();
  live.RunUntil(30000);
  Driven resumed({}, "[]");
  resumed.master.Resume(checkpoint);
  resumed.RunUntil(30000);
  EXPECT_EQ(live.master.state_digest(), resumed.master.state_digest());
  ASSERT_EQ(resumed.master.schedule().Given().size(), 1u);
}

TEST(LiveCommands, NeverWeakenAnEmergency) {
  Driven train({}, "[{time_s: 1, kind: emergency}]");
  train.master.Start();
  train.RunUntil(5000);
  const Driven copy({}, "[{time_s: 1, kind: emergency}]");
  DriverCommand release;
  release.kind = DriverCommandKind::kRelease;
  train.master.Command(release);
  train.master.Command(Apply(50.0));
  train.RunUntil(15000);
  EXPECT_GT(train.last.cylinder_pressure_pa[0], 400e3);
}

TEST(LiveCommands, ThatTheBrakeCannotObeyChangeNothing) {
  Driven train({}, "[]"), other({}, "[]");
  train.master.Start();
  other.master.Start();
  EXPECT_THROW(train.master.Command(Apply(5000.0)), std::invalid_argument);
  train.RunUntil(1000);
  other.RunUntil(1000);
  EXPECT_EQ(train.master.state_digest(), other.master.state_digest());
}

TEST(Conditions, OfAScenarioActAtTheirPlaceAndUntilEndsTheRun) {
  Driven train({"until={standing: true}", "duration_s=200"},
               "[{when: {position_m: 50}, kind: apply, reduction_kpa: 100}]");
  train.master.Start();
  train.RunUntil(1000000);
  ASSERT_EQ(train.master.schedule().Given().size(), 1u);
  EXPECT_TRUE(train.master.schedule().NotGiven().empty());
  // 50 m at 20 km/h with some resistance: just after 9.0 s
  const double given_s = 1e-3 * static_cast<double>(train.master.schedule().Given()[0].exchange);
  EXPECT_GT(given_s, 9.0);
  EXPECT_LT(given_s, 9.2);
  EXPECT_TRUE(train.master.EndedByUntil());
  EXPECT_LT(train.master.time_s(), 200.0);
  EXPECT_LT(std::abs(train.last.mean_speed_mps), 0.01);
  EXPECT_EQ(train.master.exchange() % 10, 0u);  // at a record,
  EXPECT_TRUE(train.last.ledger.has_value());   // with its ledger
}

TEST(Conditions, ThatNeverComeTrueAreTold) {
  Driven train({"duration_s=1"},
               "[{time_s: 0.5, kind: release}, {when: {position_m: 500}, kind: apply, "
               "reduction_kpa: 100}, {exchange: 5000, kind: emergency}]");
  train.master.Start();
  train.RunUntil(1000);
  EXPECT_EQ(train.master.schedule().NotGiven(),
            (std::vector<std::string>{"commands[1] (apply 100 kPa) was not given: its condition did not come true",
                                      "commands[2] (emergency) was not given: the run ended before its exchange"}));
}

}  // namespace
}  // namespace train_dynamics
