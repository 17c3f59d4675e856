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

TEST(UsefulThreads, AreNoMoreThanTheVehiclesAreWorth) {
  EXPECT_EQ(UsefulThreads(VehicleModel::kTwoD, 2, 8), 1);  // a barrier costs more
  EXPECT_EQ(UsefulThreads(VehicleModel::kTwoD, 16, 8), 2);
  EXPECT_EQ(UsefulThreads(VehicleModel::kTwoD, 242, 2), 2);
  EXPECT_EQ(UsefulThreads(VehicleModel::kLtd, 242, 8), 1);
  EXPECT_EQ(UsefulThreads(VehicleModel::kLtd, 5000, 8), 5);
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
