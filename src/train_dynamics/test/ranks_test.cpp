#include "train_dynamics/train/ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace train_dynamics {
namespace {

TEST(SplitRanks, DealsEachVehicleToOneRankInOrder) {
  for (const int vehicles : {1, 6, 242, 1001}) {
    for (int ranks = 1; ranks <= vehicles; ++ranks) {
      int next = 0;
      for (const Rank& rank : SplitRanks(vehicles, ranks)) {
        EXPECT_EQ(rank.first, next);
        EXPECT_EQ(rank.name, VehicleName(rank.first, vehicles));
        EXPECT_GE(rank.count, vehicles / ranks);
        EXPECT_LE(rank.count, vehicles / ranks + 1);
        next += rank.count;
      }
      EXPECT_EQ(next, vehicles);
    }
  }
}

TEST(SplitRanks, MakesNoMoreRanksThanVehicles) {
  EXPECT_EQ(SplitRanks(3, 8).size(), 3u);
  EXPECT_EQ(SplitRanks(3, 0).size(), 1u);
}

TEST(VehicleName, SortsAsTheVehiclesDo) {
  EXPECT_EQ(VehicleName(6, 242), "wagon_007");
  EXPECT_EQ(VehicleName(6, 999), "wagon_007");
  EXPECT_EQ(VehicleName(6, 1000), "wagon_0007");
  std::vector<std::string> names;
  for (int i = 0; i < 1234; ++i) names.push_back(VehicleName(i, 1234));
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(VehiclesText, NamesVehiclesFromOne) {
  EXPECT_EQ(VehiclesText({"", 0, 1}), "vehicle 1");
  EXPECT_EQ(VehiclesText({"", 6, 6}), "vehicles 7-12");
}

}  // namespace
}  // namespace train_dynamics
