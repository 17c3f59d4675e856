#include "train_dynamics/numeric/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallestNormal = std::numeric_limits<double>::min();
constexpr double kLargest = std::numeric_limits<double>::max();

std::vector<double> Uniform(double low, double high, int count = 300000) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> draw(low, high);
  std::vector<double> numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return draw(random); });
  return numbers;
}

// Bit patterns of every kind, the numbers that laws meet, and the special ones with their neighbours.
std::vector<double> ArgumentsOfEveryKind() {
  std::mt19937_64 random(7);
  std::vector<double> numbers(100000);
  for (double& x : numbers) x = FromBits(random());
  for (const double x : Uniform(-50.0, 50.0, 100000)) numbers.push_back(x);
  for (const double x : Uniform(-2.0, 2.0, 100000)) numbers.push_back(x);
  for (const double x : {0.0, 5e-324, 1e-310, kSmallestNormal, 0.41421356237309503, 1.0, 2.414213562373095, 8.0, 22.0,
                         708.0, 709.78, 710.0, 1e300, kLargest, kInfinity, kNaN}) {
    for (const double y : {std::nextafter(x, -kInfinity), x, std::nextafter(x, kInfinity)}) {
      numbers.push_back(y);
      numbers.push_back(-y);
    }
  }
  while (numbers.size() % 16 != 0) numbers.push_back(1.0);
  return numbers;
}

// Two NaN count as the same: no standard fixes their sign and payload.
bool SameBits(double a, double b) { return ToBits(a) == ToBits(b) || (std::isnan(a) && std::isnan(b)); }

// Calls an operation of two numbers in lanes and one by one. The second number is the first of another place.
template <int N, class Operation>
void ExpectLanesEqualScalar(const char* name, Operation operation) {
  static const std::vector<double> x = ArgumentsOfEveryKind();
  static const std::vector<double> y = [] {
    std::vector<double> shuffled = x;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(11));
    return shuffled;
  }();
  double result[N];
  for (std::size_t i = 0; i < x.size(); i += N) {
    Lanes<N>(operation(Lanes<N>::Load(&x[i]), Lanes<N>::Load(&y[i]))).Store(result);
    for (std::size_t lane = 0; lane < N; ++lane) {
      const double expected = operation(x[i + lane], y[i + lane]);
      ASSERT_TRUE(SameBits(result[lane], expected))
          << name << " of " << x[i + lane] << " and " << y[i + lane] << " in lane " << lane << " of " << N << ": "
          << result[lane] << " instead of " << expected;
    }
  }
}

template <int N>
void ExpectVocabularyEqualsScalar() {
  ExpectLanesEqualScalar<N>("+", [](auto x, auto y) { return x + y; });
  ExpectLanesEqualScalar<N>("-", [](auto x, auto y) { return x - y; });
  ExpectLanesEqualScalar<N>("*", [](auto x, auto y) { return x * y; });
  ExpectLanesEqualScalar<N>("/", [](auto x, auto y) { return x / y; });
  ExpectLanesEqualScalar<N>("compound", [](auto x, auto y) {
    auto z = -x;
    z += y;
    z *= 0.3;
    z -= x;
    z /= y;
    return z;
  });
  ExpectLanesEqualScalar<N>("<", [](auto x, auto y) { return Select(x < y, x, 1.0); });
  ExpectLanesEqualScalar<N>("<=", [](auto x, auto y) { return Select(x <= y, -0.0, y); });
  ExpectLanesEqualScalar<N>(">", [](auto x, auto y) { return Select(x > y, 1.0, 2.0); });
  ExpectLanesEqualScalar<N>(">=", [](auto x, auto y) { return Select(x >= y, 1.0, 2.0); });
  ExpectLanesEqualScalar<N>("==", [](auto x, auto y) { return Select(x == y, 1.0, 2.0); });
  ExpectLanesEqualScalar<N>("!=", [](auto x, auto y) { return Select(x != y, 1.0, 2.0); });
  ExpectLanesEqualScalar<N>("masks", [](auto x, auto y) {
    const MaskOf<decltype(x)> in_order = !(x > y);
    return Select(((0.0 < x) & in_order) | (y == 1.0), x, y);
  });
  ExpectLanesEqualScalar<N>("Max", [](auto x, auto y) { return Max(x, y); });
  ExpectLanesEqualScalar<N>("Min", [](auto x, auto y) { return Min(x, y); });
  ExpectLanesEqualScalar<N>("Clamp", [](auto x, auto y) { return Clamp(x, -1.0, Max(0.0, y)); });
  ExpectLanesEqualScalar<N>("Abs", [](auto x, auto) { return Abs(x); });
  ExpectLanesEqualScalar<N>("Sqrt", [](auto x, auto) { return Sqrt(x); });
  ExpectLanesEqualScalar<N>("CopySign", [](auto x, auto y) { return CopySign(x, y); });
  ExpectLanesEqualScalar<N>("bits", [](auto x, auto y) {
    const BitsOf<decltype(x)> bits = (ToBits(x) << 3) + (ToBits(y) >> 5) - 12345;
    return FromBits(bits);
  });
}

TEST(Lanes, VocabularyGivesTheBitsOfDouble) {
  ExpectVocabularyEqualsScalar<2>();
  ExpectVocabularyEqualsScalar<4>();
  ExpectVocabularyEqualsScalar<8>();
  ExpectVocabularyEqualsScalar<16>();
}

template <int N>
void ExpectElementaryEqualsScalar() {
  ExpectLanesEqualScalar<N>("Exp", [](auto x, auto) { return Exp(x); });
  ExpectLanesEqualScalar<N>("Decay", [](auto x, auto) { return Decay(Abs(x)); });
  ExpectLanesEqualScalar<N>("Atan", [](auto x, auto) { return Atan(x); });
  ExpectLanesEqualScalar<N>("InverseCbrt", [](auto x, auto) { return InverseCbrt(x); });
  ExpectLanesEqualScalar<N>("Polynomial", [](auto x, auto) { return Polynomial(x, 1.0, -0.5, 0.3, 1e-3); });
}

TEST(Lanes, ElementaryFunctionsGiveTheBitsOfDouble) {
  ExpectElementaryEqualsScalar<2>();
  ExpectElementaryEqualsScalar<4>();
  ExpectElementaryEqualsScalar<8>();
  ExpectElementaryEqualsScalar<16>();
}

TEST(Lanes, AnyAndAll) {
  const double numbers[] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  const auto x = Lanes<8>::Load(numbers);
  EXPECT_TRUE(AnyOf(x > 7.5));
  EXPECT_FALSE(AnyOf(x > 8.0));
  EXPECT_TRUE(AllOf(x > 0.5));
  EXPECT_FALSE(AllOf(x > 1.0));
  EXPECT_TRUE(AnyOf(1.0 > 0.5) && AllOf(1.0 > 0.5));
  EXPECT_EQ(x[6], 7.0);
}

TEST(Lanes, ADoubleFillsThePackAsItIs) {
  const Lanes<8> x = -0.0;
  for (int lane = 0; lane < 8; ++lane) EXPECT_EQ(ToBits(x[lane]), ToBits(-0.0));
  const Lanes<8> zero{};
  for (int lane = 0; lane < 8; ++lane) EXPECT_EQ(ToBits(zero[lane]), ToBits(0.0));
}

}  // namespace
}  // namespace train_dynamics
