// Patches of rail that come while the train runs, live or as commands of the scenario, beside patches of the track.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "simulate.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {
namespace {

constexpr double kFromM = 20.0, kToM = 200.0, kFriction = 0.01;
const std::string kOfTrack =
    "track={name: slippery, friction_patches: [{from_m: 20, to_m: 200, friction_coefficient: 0.01}]}";

DriverCommand Patch(double from_m = kFromM, double to_m = kToM, double friction = kFriction) {
  DriverCommand command;
  command.kind = DriverCommandKind::kFriction;
  command.from_m = from_m;
  command.to_m = to_m;
  command.friction_coefficient = friction;
  return command;
}

/// Ten vehicles whose foremost one is at 0 m, with 36 km/h, under an emergency brake from the start: it comes to 20 m
/// after 2 s.
struct Slippery {
  explicit Slippery(const std::vector<std::string>& more, int threads = 1)
      : scenario(config::LoadScenario(ScenarioFile("emergency"), Overrides(more))),
        vehicles(scenario.params, scenario.consist, threads),
        master(scenario.params, scenario.consist, vehicles, scenario.pressures) {}
  static std::vector<std::string> Overrides(const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {
        "brake=single_vehicle", "adhesion_limit=true",      "duration_s=4",
        "initial_speed_kmh=36", "train.consist[1].count=4", "train.consist[3].count=4",
        "detail_vehicles=[]",   "record_interval_s=0.1",    "commands=[{time_s: 0, kind: emergency}]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return overrides;
  }
  void RunUntil(std::uint64_t exchange) {
    while (!master.Done() && master.exchange() < exchange) master.Exchange();
  }
  std::uint64_t Digest() {
    RunUntil(1000000);
    return master.state_digest();
  }

  config::LoadedScenario scenario;
  InProcessTransport vehicles;
  TrainMaster master;
};

std::uint64_t DigestOf(const std::vector<std::string>& more) {
  Slippery run(more);
  run.master.Start();
  return run.Digest();
}

class PatchesOnTheWay : public testing::TestWithParam<std::string> {
 protected:
  /// The digest of a run into which the patch comes at an exchange.
  std::uint64_t Live(std::uint64_t exchange, int threads = 1) {
    Slippery run({GetParam()}, threads);
    run.master.Start();
    run.RunUntil(exchange);
    run.master.Command(Patch());
    return run.Digest();
  }
};

TEST_P(PatchesOnTheWay, OneThatComesAheadOfTheTrainIsAsOneOfTheTrack) {
  const std::uint64_t of_track = DigestOf({GetParam(), kOfTrack});
  EXPECT_NE(of_track, DigestOf({GetParam()}));
  EXPECT_EQ(of_track, Live(0));
  EXPECT_EQ(of_track, Live(1234));
  EXPECT_EQ(of_track, Live(1234, 3));
  EXPECT_NE(of_track, Live(3000));  // under the train: it has felt the dry rail till then
}

TEST_P(PatchesOnTheWay, AreCommandsOfTheScenarioToo) {
  const std::string patch = "kind: friction, from_m: 20, to_m: 200, friction_coefficient: 0.01}";
  const std::uint64_t live = Live(3000);
  EXPECT_EQ(live, DigestOf({GetParam(), "commands=[{time_s: 0, kind: emergency}, {exchange: 3000, " + patch + "]"}));
  EXPECT_EQ(live, DigestOf({GetParam(), "commands=[{time_s: 0, kind: emergency}, {time_s: 3, " + patch + "]"}));
  EXPECT_NE(live, DigestOf({GetParam(), "commands=[{time_s: 0, kind: emergency}, {time_s: 3.001, " + patch + "]"}));
}

TEST_P(PatchesOnTheWay, GoOnFromACheckpoint) {
  Slippery run({GetParam()});
  run.master.Start();
  run.RunUntil(2500);
  run.master.Command(Patch());
  run.RunUntil(2999);
  run.master.AskForCheckpoint();
  run.RunUntil(3000);
  const TrainCheckpoint checkpoint = DecodeTrainCheckpoint(Encode(run.master.Checkpoint()));
  run.master.Command(Patch(-20.0, 30.0, 0.4));
  Slippery resumed({GetParam()}, 2);
  resumed.master.Resume(checkpoint);
  resumed.master.Command(Patch(-20.0, 30.0, 0.4));
  EXPECT_EQ(run.Digest(), resumed.Digest());
}

INSTANTIATE_TEST_SUITE_P(OfBothModels, PatchesOnTheWay, testing::Values("model=2d", "model=ltd"));

TEST(PatchesOnTheWayRules, ThereAreNoMoreThanAHundred) {
  Slippery run(
      {"commands=[{time_s: 0, kind: emergency}, {time_s: 1, kind: friction, from_m: 5, to_m: 6, "
       "friction_coefficient: 0.2}]"});
  run.master.Start();
  for (std::size_t i = 1; i < kMostPatchesOnTheWay; ++i) run.master.Command(Patch());
  EXPECT_THROW(run.master.Command(Patch()), std::invalid_argument);
  run.RunUntil(1);
  EXPECT_THROW(run.master.Command(Patch()), std::invalid_argument);
}

TEST(PatchesOnTheWayRules, NoEndLiesWithinARampOfTheTrack) {
  TrackParams track;
  track.friction_patches = {{100.0, 200.0, 0.1, {}, 4.0}};
  for (const double at_m : {98.1, 100.0, 101.9, 198.1, 201.9}) EXPECT_TRUE(IsWithinRamp(track, at_m)) << at_m;
  for (const double at_m : {97.9, 98.0, 102.0, 150.0, 202.1}) EXPECT_FALSE(IsWithinRamp(track, at_m)) << at_m;
  ASSERT_EQ(JudgePatch({50.0, 101.0, 0.2, {}, {}}, "command", track).size(), 1u);
  EXPECT_EQ(JudgePatch({50.0, 101.0, 0.2, {}, {}}, "command", track).front().key, "command.to_m");
  EXPECT_TRUE(JudgePatch({50.0, 250.0, 0.2, {}, {}}, "command", track).empty());
}

TEST(PatchesOnTheWayRules, TheLaterOneHolds) {
  TrackParams params;
  params.friction_patches = {{0.0, 100.0, 0.1, {}, {}}};
  Track track(params);
  AdhesionParams own;
  own.friction_coefficient = 0.4;
  const auto at = [&](double at_m) { return track.SurfaceAt(at_m, own).friction_coefficient; };
  track.AddPatches({{50.0, 150.0, 0.2, {}, {}}, {60.0, 70.0, 0.3, {}, {}}});
  track.AddPatches({{65.0, 68.0, 0.05, {}, {}}});
  EXPECT_EQ(at(-1.0), 0.4);
  EXPECT_EQ(at(49.0), 0.1);
  EXPECT_EQ(at(51.0), 0.2);
  EXPECT_EQ(at(61.0), 0.3);
  EXPECT_EQ(at(66.0), 0.05);
  EXPECT_EQ(at(69.0), 0.3);
  EXPECT_EQ(at(149.0), 0.2);
  EXPECT_EQ(at(150.0), 0.4);
}

}  // namespace
}  // namespace train_dynamics
