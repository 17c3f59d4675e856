#include "ltd_master/ranks/late_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace ltd_master {
namespace {

using train_dynamics::Rank;

const std::function<bool()> kNever = [] { return false; };
const std::function<bool()> kAlways = [] { return true; };

std::vector<Rank> Ranks(int count) {
  std::vector<Rank> ranks;
  for (int i = 0; i < count; ++i) ranks.push_back({"/train/wagon_" + std::to_string(2 * i + 1), 2 * i, 2});
  return ranks;
}

std::string WhyGivenUp(const LateWatch& watch, const std::vector<LostRank>& lost) {
  try {
    watch.GiveUp(lost);
  } catch (const RankFailure& e) {
    return e.what();
  }
}

TEST(LateWatch, WithoutADeadlineNobodyIsLost) {
  const std::vector<Rank> ranks = Ranks(2);
  LateWatch watch(ranks, "exchange 17", 0.0, kNever);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(watch.Look({true, true}));
  EXPECT_FALSE(watch.was_late());
}

TEST(LateWatch, TheDeadlinePasses) {
  const std::vector<Rank> ranks = Ranks(2);
  LateWatch watch(ranks, "exchange 17", 1e-3, kNever);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(watch.Look({true, false}));
  EXPECT_EQ(watch.NoReply(), "no reply within 0.001 s");
}

TEST(LateWatch, AnInterruptionEndsTheWaitBeforeTheDeadlineIsAskedFor) {
  const std::vector<Rank> ranks = Ranks(2);
  LateWatch watch(ranks, "exchange 17", 1e-9, kAlways);
  EXPECT_THROW(watch.Look({true, true}), WaitInterrupted);
  EXPECT_THROW(watch.GiveUp({{0, "closed the connection"}}), WaitInterrupted);
}

TEST(LateWatch, NamesWhoIsLostAndWhy) {
  const std::vector<Rank> ranks = Ranks(3);
  const LateWatch watch(ranks, "exchange 17", 30.0, kNever);
  EXPECT_EQ(WhyGivenUp(watch, {{1, "closed the connection"}, {0, watch.NoReply()}, {2, watch.NoReply()}}),
            "/train/wagon_3 (vehicles 3-4), exchange 17: closed the connection; exchange 17: no reply within "
            "30 s from "
            "/train/wagon_1 (vehicles 1-2), /train/wagon_5 (vehicles 5-6)");
}

TEST(LateWatch, NamesTheFirstFiveOfMany) {
  const std::vector<Rank> ranks = Ranks(8);
  EXPECT_EQ(NamesOf(ranks, std::vector<bool>(8, false)), "");
  EXPECT_EQ(NamesOf(ranks, {false, true, false, false, false, false, false, true}),
            "/train/wagon_3 (vehicles 3-4), /train/wagon_15 (vehicles 15-16)");
  const std::string all = NamesOf(ranks, std::vector<bool>(8, true));
  EXPECT_NE(all.find("/train/wagon_9 (vehicles 9-10) and 3 more"), std::string::npos) << all;
}

}  // namespace
}  // namespace ltd_master
