#include "train_dynamics/numeric/digest.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace train_dynamics {
namespace {

std::uint64_t DigestOf(const std::vector<double>& numbers) {
  Digest digest;
  for (const double number : numbers) digest.Add(number);
  return digest.value();
}

TEST(Digest, IsThatOfTheBitsInTheirOrder) {
  EXPECT_EQ(DigestOf({1.0, 2.0}), DigestOf({1.0, 2.0}));
  EXPECT_NE(DigestOf({1.0, 2.0}), DigestOf({2.0, 1.0}));
  EXPECT_NE(DigestOf({1.0}), DigestOf({1.0, 0.0}));
  EXPECT_NE(DigestOf({}), DigestOf({0.0}));
  EXPECT_NE(DigestOf({0.0}), DigestOf({-0.0}));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(DigestOf({kNaN}), DigestOf({kNaN}));
}

// Mix is a bijection: sequences that differ in one number never have the same digest.
TEST(Digest, NoSingleBitGetsLost) {
  std::set<std::uint64_t> seen{DigestOf({1.5, -2.25, 3e300})};
  for (int bit = 0; bit < 64; ++bit) {
    for (const int changed : {0, 1, 2}) {
      std::vector<double> numbers{1.5, -2.25, 3e300};
      numbers[changed] = FromBits(ToBits(numbers[changed]) ^ (std::uint64_t{1} << bit));
      EXPECT_TRUE(seen.insert(DigestOf(numbers)).second) << "number " << changed << ", bit " << bit;
    }
  }
}

// Half of the 64 bits change for each bit of the input, give or take 4 standard deviations (4 x 4 bits) of any one.
TEST(Digest, EveryBitChangesAboutHalfOfTheResult) {
  const std::uint64_t plain = DigestOf({1.0});
  int changed = 0;
  for (int bit = 0; bit < 64; ++bit) {
    const int one = __builtin_popcountll(plain ^ DigestOf({FromBits(ToBits(1.0) ^ (std::uint64_t{1} << bit))}));
    EXPECT_GE(one, 16) << bit;
    EXPECT_LE(one, 48) << bit;
    changed += one;
  }
  EXPECT_NEAR(changed / 64.0, 32.0, 2.0);
}

TEST(TextDigest, KnowsLengthAndZeros) {
  EXPECT_EQ(TextDigest("a train"), TextDigest("a train"));
  std::set<std::uint64_t> seen;
  for (int zeros = 0; zeros < 20; ++zeros)
    EXPECT_TRUE(seen.insert(TextDigest(std::string(zeros, '\0'))).second) << zeros;
  EXPECT_NE(TextDigest("12345678a"), TextDigest("a12345678"));
}

}  // namespace
}  // namespace train_dynamics
