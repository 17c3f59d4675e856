// Commands to a running train: what is refused in which words, which vehicles a group is, when commands come due.
#include "ltd_master/live_commands.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"

namespace ltd_master {
namespace {

train_dynamics::ScenarioParams Train() {
  return train_dynamics::config::LoadScenario(
             std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/drive_and_stop.yaml",
             {"train={name: dp, connection: mt2, consist: [{vehicle: c44ac, name: lead}, {vehicle: hopper, "
              "count: 3}, {vehicle: c44ac_trailing, count: 2, name: remote}, {vehicle: hopper, count: 3}, "
              "{vehicle: c44ac_trailing, name: remote}]}"})
      .params;
}

train_brake_msgs::DriverCommand Throttle(const std::string& group, const std::vector<int>& vehicles = {}) {
  train_brake_msgs::DriverCommand command;
  command.kind = "throttle";
  command.notch = 4.0;
  command.group = group;
  command.vehicles.assign(vehicles.begin(), vehicles.end());
  return command;
}

std::string WhyNot(const LiveCommands& live, const train_brake_msgs::DriverCommand& command) {
  try {
    live.Judge(command, 0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(LiveCommands, AGroupIsItsLocomotivesWhereverTheyStand) {
  const train_dynamics::ScenarioParams scenario = Train();
  const LiveCommands live(scenario);
  const train_dynamics::DriverCommand command = live.Judge(Throttle("remote"), 7);
  EXPECT_EQ(command.vehicles, (std::vector<int>{5, 6, 10}));
  EXPECT_EQ(command.group, "");  // what is recorded has numbers
  EXPECT_EQ(command.exchange, 7.0);
  EXPECT_TRUE(live.Judge(Throttle(""), 7).vehicles.empty());  // all
}

TEST(LiveCommands, RefuseGroupsInTheWordsOfScenarios) {
  const train_dynamics::ScenarioParams scenario = Train();
  const LiveCommands live(scenario);
  EXPECT_EQ(WhyNot(live, Throttle("lead")), "");
  EXPECT_EQ(WhyNot(live, Throttle("remot")),
            "group must be the name of a group of locomotives of the train: lead, remote, got 'remot'");
  EXPECT_EQ(WhyNot(live, Throttle("lead", {1})), "group must not stand beside vehicles");
}

TEST(LiveCommands, ComeDueAtTheNextExchangeInTheOrderOfTheirArrival) {
  const train_dynamics::ScenarioParams scenario = Train();
  LiveCommands live(scenario);
  live.Receive(Throttle("lead"));
  live.Receive(Throttle("remote"));
  const std::vector<train_dynamics::DriverCommand> due = live.Take(3, 0);
  ASSERT_EQ(due.size(), 2u);
  EXPECT_EQ(due[0].vehicles, (std::vector<int>{1}));
  EXPECT_EQ(due[1].vehicles, (std::vector<int>{5, 6, 10}));
  EXPECT_TRUE(live.Take(4, 0).empty());
  EXPECT_EQ(live.Receive(Throttle("lead")), 5u);
}

train_brake_msgs::DriverCommand Patch(double from_m, double to_m, double friction_coefficient = 0.05) {
  train_brake_msgs::DriverCommand command;
  command.kind = "friction";
  command.from_m = from_m;
  command.to_m = to_m;
  command.friction_coefficient = friction_coefficient;
  return command;
}

TEST(LiveCommands, RefusePatchesThatAreNone) {
  train_dynamics::ScenarioParams scenario = Train();
  const LiveCommands live(scenario);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  scenario.model = train_dynamics::VehicleModel::kTwoD;
  scenario.track.friction_patches = {{100.0, 200.0, 0.1, {}, 4.0}};
  EXPECT_EQ(WhyNot(live, Patch(-50.0, 98.0)), "");
  EXPECT_EQ(WhyNot(live, Patch(-50.0, 99.0)), "to_m must not lie within a ramp between surfaces of the track");
  EXPECT_EQ(WhyNot(live, Patch(0.0, kInfinite)), "to_m must be finite, got inf");
  EXPECT_EQ(WhyNot(live, Patch(kNan, 50.0)), "from_m must be finite, got nan");
  EXPECT_EQ(WhyNot(live, Patch(50.0, 50.0)), "to_m must be greater than from_m, 50, got 50");
  for (const double friction : {0.0, -0.1, 1.001, kNan, kInfinite})
    EXPECT_NE(WhyNot(live, Patch(0.0, 50.0, friction)), "") << friction;
  scenario.model = train_dynamics::VehicleModel::kLtd;
  EXPECT_EQ(WhyNot(live, Patch(0.0, 50.0)), "");
  scenario.adhesion_limit = false;
  EXPECT_EQ(WhyNot(live, Patch(0.0, 50.0)),
            "kind friction changes nothing: the ltd model leaves out the rail's friction without adhesion_limit");
}

TEST(LiveCommands, RefuseAPatchTooManyAtOnce) {
  train_dynamics::ScenarioParams scenario = Train();
  scenario.model = train_dynamics::VehicleModel::kTwoD;
  LiveCommands live(scenario);
  EXPECT_TRUE(live.Take(0, train_dynamics::kMostPatchesOnTheWay - 3).empty());
  live.Receive(Patch(0.0, 1.0));
  live.Receive(Patch(0.0, 1.0));
  EXPECT_EQ(live.Take(1, train_dynamics::kMostPatchesOnTheWay - 3).size(), 2u);
  live.Receive(Patch(0.0, 1.0));
  EXPECT_THROW(live.Receive(Patch(0.0, 1.0)), std::invalid_argument);
  live.Receive(Throttle(""));
  EXPECT_EQ(live.Take(2, train_dynamics::kMostPatchesOnTheWay - 1).size(), 2u);
  EXPECT_THROW(live.Receive(Patch(0.0, 1.0)), std::invalid_argument);
}

}  // namespace
}  // namespace ltd_master
