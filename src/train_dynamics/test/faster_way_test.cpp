#include "train_dynamics/train/faster_way.h"

#include <gtest/gtest.h>

#include <array>

namespace train_dynamics {
namespace {

/// Rounds of two ways until so much time is over. @return the time spent with each
std::array<double, 2> Spend(FasterWay& faster, double seconds, const std::array<double, 2>& round_s) {
  std::array<double, 2> spent{0.0, 0.0};
  while (spent[0] + spent[1] < seconds) {
    const int way = faster.way();
    faster.Took(round_s[way]);
    spent[way] += round_s[way];
  }
  return spent;
}

TEST(FasterWay, TakesTheFasterOneNearlyAlways) {
  for (const int best : {0, 1}) {
    FasterWay faster;
    std::array<double, 2> round_s{30e-6, 30e-6};
    round_s[best] = 20e-6;
    const std::array<double, 2> spent = Spend(faster, 3.0, round_s);
    EXPECT_GT(spent[best] / (spent[0] + spent[1]), 0.97) << best;
    EXPECT_GT(spent[1 - best], 0.0) << best;
  }
}

TEST(FasterWay, TheFirstWayIsMeasuredBeforeTheOther) {
  FasterWay faster;
  EXPECT_EQ(0, faster.way());
  for (double spent = 0.0; spent < 0.9 * FasterWay::kTrial; spent += 1e-4) {
    faster.Took(1e-4);
    EXPECT_EQ(0, faster.way());
  }
}

TEST(FasterWay, FollowsAMachineThatBecomesBusyAndQuietAgain) {
  FasterWay faster;
  const std::array<double, 2> quiet{20e-6, 30e-6}, busy{90e-6, 30e-6};
  Spend(faster, 3.0, quiet);
  EXPECT_GT(Spend(faster, 3.0, busy)[1], 0.9 * 3.0);
  EXPECT_EQ(1, faster.way());
  Spend(faster, 5.0, quiet);  // no more than a while until the next trial
  EXPECT_GT(Spend(faster, 3.0, quiet)[0], 0.9 * 3.0);
}

TEST(FasterWay, RareLongRoundsCount) {
  FasterWay faster;
  double spent_there = 0.0, all = 0.0;
  for (int round = 0; all < 3.0; ++round) {
    const int way = faster.way();
    // Way 0 is faster in 99 rounds of 100, but waits 4 ms for its core in the other.
    const double took = way == 1 ? 30e-6 : round % 100 == 0 ? 4e-3 : 20e-6;
    faster.Took(took);
    all += took;
    if (way == 0) spent_there += took;
  }
  EXPECT_LT(spent_there, 0.15 * all);
}

}  // namespace
}  // namespace train_dynamics
