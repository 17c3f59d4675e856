#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "simulate.h"
#include "train_dynamics/train/thread_team.h"

namespace train_dynamics {
namespace {

TEST(ThreadTeam, RunsEveryTaskOnceInEveryRound) {
  for (int size : {1, 2, 5}) {
    ThreadTeam team(size);
    std::vector<int> calls(size, 0);
    for (int round = 1; round <= 2000; ++round) {
      // Now and then longer than the team spins, so that it goes to sleep.
      if (round % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      team.Run([&](int member) {
        if ((round + member) % 150 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++calls[member];
      });
      ASSERT_EQ(std::vector<int>(size, round), calls);
    }
  }
}

TEST(UsableCores, AreThoseThatTheSystemAllows) {
  cpu_set_t before, one;
  ASSERT_EQ(0, sched_getaffinity(0, sizeof before, &before));
  EXPECT_EQ(CPU_COUNT(&before), UsableCores());
  CPU_ZERO(&one);
  CPU_SET(sched_getcpu(), &one);
  ASSERT_EQ(0, sched_setaffinity(0, sizeof one, &one));
  EXPECT_EQ(1, UsableCores());
  ASSERT_EQ(0, sched_setaffinity(0, sizeof before, &before));
}

/// Threads worth having for a train of these groups: (model, count).
int ThreadsFor(const std::vector<std::pair<VehicleModel, int>>& groups, int threads) {
  ScenarioParams scenario;
  int count = 0;
  for (const auto& [model, vehicles] : groups) {
    ConsistGroupParams group;
    group.model = model;
    group.count = vehicles;
    scenario.train.consist.push_back(group);
    count += vehicles;
  }
  return UsefulThreads(scenario, 0, count, threads);
}

TEST(UsefulThreads, AreNoMoreThanTheVehiclesAreWorth) {
  EXPECT_EQ(ThreadsFor({{VehicleModel::kTwoD, 2}}, 8), 1);  // a barrier costs more
  EXPECT_EQ(ThreadsFor({{VehicleModel::kTwoD, 16}}, 8), 2);
  EXPECT_EQ(ThreadsFor({{VehicleModel::kTwoD, 242}}, 2), 2);
  EXPECT_EQ(ThreadsFor({{VehicleModel::kLtd, 242}}, 8), 1);
  EXPECT_EQ(ThreadsFor({{VehicleModel::kLtd, 5000}}, 8), 5);
  EXPECT_EQ(ThreadsFor({{VehicleModel::kLtd, 500}, {VehicleModel::kTwoD, 16}}, 8), 2);
}

TEST(Threads, AnyNumberGivesTheSameBitsOfMixedModels) {
  const std::vector<std::string> overrides = {"duration_s=3.5", "train.consist[0].model=ltd"};
  const Outcome one = Simulate("emergency", overrides, 1);
  for (const int threads : {2, 3, 242}) EXPECT_EQ(Simulate("emergency", overrides, threads).digest, one.digest);
  EXPECT_NE(Simulate("emergency", {"duration_s=3.5"}, 1).digest, one.digest);
}

TEST(Threads, AnyNumberGivesTheSameBits) {
  for (const char* model : {"model=2d", "model=ltd"}) {
    const std::vector<std::string> overrides = {model, "duration_s=3.5"};  // 1.5 s of braking
    const Outcome one = Simulate("emergency", overrides, 1);
    EXPECT_EQ(Simulate("emergency", overrides, 2).digest, one.digest);
    EXPECT_EQ(Simulate("emergency", overrides, 3).digest, one.digest);
    // The digest sees the last bit of the start speed.
    const std::string nudge = "initial_speed_kmh=80.00000000000001";
    EXPECT_NE(Simulate("emergency", {model, "duration_s=3.5", nudge}).digest, one.digest);
  }
}

TEST(Threads, AsManyAsVehiclesAtMost) {
  const Outcome one = Simulate("dip", {"duration_s=1"}, 1);
  EXPECT_EQ(Simulate("dip", {"duration_s=1"}, 16).digest, one.digest);
}

}  // namespace
}  // namespace train_dynamics
