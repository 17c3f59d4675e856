// Look-up by position, against a count of all entries.

#include "train_dynamics/track/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The number of cuts at or before a position, counted one by one.
int Counted(const std::vector<double>& cuts, double x) {
  std::vector<double> distinct = cuts;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return static_cast<int>(std::count_if(distinct.begin(), distinct.end(), [x](double c) { return c <= x; }));
}

void ExpectCounted(const std::vector<double>& cuts, std::vector<double> positions) {
  const Pieces pieces(cuts);
  for (const double cut : cuts) {
    for (const double x : {cut, std::nextafter(cut, -kInfinity), std::nextafter(cut, kInfinity)}) {
      positions.push_back(x);
    }
  }
  for (const double x : positions) {
    const int number = pieces.NumberAt(x);
    ASSERT_EQ(number, Counted(cuts, x)) << x;
    EXPECT_LE(pieces[number].from_m, x);
    EXPECT_TRUE(x < pieces[number].to_m || x == kInfinity);
  }
}

TEST(Pieces, AreThoseOfAScan) {
  std::mt19937 random(1);
  for (const int count : {0, 1, 2, 3, 17, 300}) {
    for (const double length : {1.0, 1e3, 1e7}) {
      std::uniform_real_distribution<double> along(-length, length);
      std::vector<double> cuts, positions = {-kInfinity, kInfinity, 0.0, -0.0, 1e308, -1e308};
      for (int i = 0; i < count; ++i) cuts.push_back(along(random));
      for (int i = 0; i < 100; ++i) positions.push_back(1.5 * along(random));
      ExpectCounted(cuts, positions);
    }
  }
}

TEST(Pieces, OfCutsThatCrowdLieFarApartOrCoincide) {
  std::vector<double> crowd = {-1e9, 1e9, 5.0, 5.0, 5.0};
  for (int i = 0; i < 100; ++i) crowd.push_back(1e-9 * i);
  ExpectCounted(crowd, {0.5e-9, 1.0, 6.0});
  ExpectCounted({-1.7e308, 0.0, 1.7e308}, {1.0, -1.0});
  ExpectCounted({0.0, 5e-324, 1e-323}, {1.0, -1.0});
  ExpectCounted({100.0, 100.0 + 1e-13}, {100.0 + 5e-14});
  const Pieces pieces({1.0, 2.0});
  const int of_nan = pieces.NumberAt(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(of_nan >= 0 && of_nan < pieces.count());
}

}  // namespace
}  // namespace train_dynamics
