#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallestNormal = std::numeric_limits<double>::min();
constexpr double kLargest = std::numeric_limits<double>::max();

const long double kLog2 = std::log(2.0L);
const long double kPi = 4.0L * std::atan(1.0L);

const auto kExp = [](auto x) { return Exp(x); };
const auto kTanh = [](auto x) { return Tanh(x); };
const auto kAtan = [](auto x) { return Atan(x); };
const auto kInverseCbrt = [](auto x) { return InverseCbrt(x); };

// The spacing of doubles at a normal number.
double Ulp(long double value) { return std::ldexp(1.0, std::ilogb(value) - (DBL_MANT_DIG - 1)); }

std::vector<double> Uniform(double low, double high, int count = 300000) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> draw(low, high);
  std::vector<double> numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return draw(random); });
  return numbers;
}

// 2^low to 2^high, every binade as often as every other.
std::vector<double> Logarithmic(double low, double high) {
  std::vector<double> numbers = Uniform(low, high);
  for (double& x : numbers) x = std::exp2(x);
  return numbers;
}

// Compares with the C library in extended precision, which errs by an ulp of its own, that is 2^-11 of ours.
constexpr double kReferenceError = 0.0005;
static_assert(LDBL_MANT_DIG >= 64, "the reference needs extended precision");

template <class Function, class Reference>
void ExpectErrorBelow(double bound_ulp, Function function, Reference reference,
                      const std::vector<double>& arguments) {
  for (const double x : arguments) {
    const long double exact = reference(static_cast<long double>(x));
    const double error_ulp = static_cast<double>(std::abs(function(x) - exact)) / Ulp(exact);
    ASSERT_LT(error_ulp, bound_ulp + kReferenceError) << "at " << x;
  }
}

long double ExactExp(long double x) { return std::exp(x); }
long double ExactTanh(long double x) { return std::tanh(x); }
long double ExactAtan(long double x) { return std::atan(x); }
long double ExactInverseCbrt(long double x) { return 1.0L / std::cbrt(x); }

TEST(Scalar, MaxAndMinKeepTheSecondOperandWhereNothingIsGreater) {
  static_assert(Max(1.0, 2.0) == 2.0 && Max(2.0, 1.0) == 2.0 && Min(1.0, 2.0) == 1.0);
  EXPECT_TRUE(std::isnan(Max(0.0, kNaN)));
  EXPECT_TRUE(std::isnan(Min(0.0, kNaN)));
  EXPECT_EQ(Max(kNaN, 0.0), 0.0);
  EXPECT_EQ(Min(kNaN, 0.0), 0.0);
  EXPECT_TRUE(std::signbit(Max(0.0, -0.0)));
  EXPECT_FALSE(std::signbit(Min(-0.0, 0.0)));
}

TEST(Scalar, ClampKeepsNaN) {
  static_assert(Clamp(-3.0, -1.0, 2.0) == -1.0 && Clamp(3.0, -1.0, 2.0) == 2.0 &&
                Clamp(0.5, -1.0, 2.0) == 0.5);
  EXPECT_EQ(Clamp(kInfinity, -1.0, 2.0), 2.0);
  EXPECT_TRUE(std::isnan(Clamp(kNaN, -1.0, 2.0)));
}

TEST(Scalar, SignsAndBits) {
  static_assert(CopySign(3.0, -0.0) == -3.0 && CopySign(-3.0, 2.0) == 3.0 && Abs(-3.0) == 3.0);
  static_assert(ToBits(1.0) == 0x3ff0000000000000 && FromBits(ToBits(-0.1)) == -0.1);
  EXPECT_FALSE(std::signbit(Abs(-0.0)));
  EXPECT_TRUE(std::isnan(Abs(kNaN)));
  EXPECT_TRUE(std::isnan(Sqrt(-1.0)));
}

TEST(Exp, ErrorIsBelowOneUlp) {
  ExpectErrorBelow(1.0, kExp, ExactExp, Uniform(-708.0, 709.78));
  ExpectErrorBelow(1.0, kExp, ExactExp, Uniform(-1.0, 1.0));
  ExpectErrorBelow(1.0, kExp, ExactExp, Logarithmic(-70.0, 0.0));
}

TEST(Exp, EndsOfItsRange) {
  static_assert(Exp(0.0) == 1.0 && Exp(-0.0) == 1.0);
  EXPECT_GT(Exp(-708.0), kSmallestNormal);
  EXPECT_EQ(Exp(std::nextafter(-708.0, -709.0)), 0.0);
  EXPECT_EQ(Exp(-kInfinity), 0.0);
  EXPECT_LT(Exp(709.78), kInfinity);
  EXPECT_EQ(Exp(709.79), kInfinity);
  EXPECT_EQ(Exp(1e300), kInfinity);
  EXPECT_EQ(Exp(kInfinity), kInfinity);
}

TEST(Tanh, ErrorIsBelowThreeUlpAlsoNearZero) {
  ExpectErrorBelow(3.0, kTanh, ExactTanh, Uniform(0.0, 25.0));
  ExpectErrorBelow(3.0, kTanh, ExactTanh, Uniform(0.0, 1.0));
  ExpectErrorBelow(3.0, kTanh, ExactTanh, Logarithmic(-1000.0, 0.0));
}

TEST(Tanh, LimitsAreExact) {
  for (const double x : {22.0, 1e3, 1e300, kInfinity}) EXPECT_EQ(Tanh(x), 1.0) << x;
  for (const double x : Uniform(0.0, 30.0)) ASSERT_LE(Tanh(x), 1.0) << x;
  // tanh x = x (1 - x^2 / 3 ...): below 1e-9 the difference is less than half an ulp.
  for (const double x : {0.0, 5e-324, 1e-310, 1e-100, 1e-20}) EXPECT_EQ(Tanh(x), x);
}

TEST(Atan, ErrorIsBelowTwoUlp) {
  ExpectErrorBelow(2.0, kAtan, ExactAtan, Uniform(0.0, 3.0));
  ExpectErrorBelow(2.0, kAtan, ExactAtan, Logarithmic(-1000.0, 1000.0));
}

TEST(Atan, LimitsAreExact) {
  EXPECT_EQ(Atan(1.0), static_cast<double>(kPi / 4.0L));
  for (const double x : {1e17, 1e300, kLargest, kInfinity})
    EXPECT_EQ(Atan(x), static_cast<double>(kPi / 2.0L)) << x;
  for (const double x : {0.0, 5e-324, 1e-310, 1e-100, 1e-20}) EXPECT_EQ(Atan(x), x);
}

TEST(InverseCbrt, ErrorIsBelowOneAndAQuarterUlp) {
  ExpectErrorBelow(1.25, kInverseCbrt, ExactInverseCbrt, Uniform(1.0, 8.0));
  ExpectErrorBelow(1.25, kInverseCbrt, ExactInverseCbrt, Logarithmic(-1022.0, 1023.99));
  ExpectErrorBelow(1.25, kInverseCbrt, ExactInverseCbrt, {kSmallestNormal, kLargest});
}

TEST(InverseCbrt, OutsideOfItsDomain) {
  // The cube root x y^2 vanishes with x, without a division by zero in between.
  for (const double x : {0.0, -0.0, 5e-324, 1e-310}) {
    const double y = InverseCbrt(x);
    EXPECT_LT(std::abs(x * y * y), 1e-102) << x;
  }
  for (const double x : {-5e-324, -1.0, -kInfinity, kInfinity}) EXPECT_TRUE(std::isnan(InverseCbrt(x))) << x;
}

TEST(Elementary, OddFunctionsAreExactlyOdd) {
  for (const double x : Logarithmic(-1070.0, 1020.0)) {
    ASSERT_EQ(Tanh(-x), -Tanh(x)) << x;
    ASSERT_EQ(Atan(-x), -Atan(x)) << x;
  }
  EXPECT_TRUE(std::signbit(Tanh(-0.0)));
  EXPECT_TRUE(std::signbit(Atan(-0.0)));
}

TEST(Elementary, NaNIsNotHidden) {
  for (const double nan : {kNaN, -kNaN}) {
    EXPECT_TRUE(std::isnan(Exp(nan)));
    EXPECT_TRUE(std::isnan(Tanh(nan)));
    EXPECT_TRUE(std::isnan(Atan(nan)));
    EXPECT_TRUE(std::isnan(InverseCbrt(nan)));
  }
}

// Walks over the consecutive doubles around a seam of the range reduction. Rounding may let a slowly growing
// result step back, but by no more than one ulp; 64 steps apart the functions below have grown by more than
// twice the bound of their error (5 ulp or more at these seams), so that order must be kept strictly.
template <class Function>
void ExpectToGrowAcross(double seam, Function function) {
  constexpr int kSteps = 20000, kApart = 64;
  double x = seam;
  for (int i = 0; i < kSteps / 2; ++i) x = std::nextafter(x, -kInfinity);
  std::vector<double> y;
  for (int i = 0; i < kSteps; ++i, x = std::nextafter(x, kInfinity)) y.push_back(function(x));
  for (int i = 1; i < kSteps; ++i) ASSERT_GE(y[i], y[i - 1] - Ulp(y[i])) << "near " << seam;
  for (int i = kApart; i < kSteps; ++i) ASSERT_GT(y[i], y[i - kApart]) << "near " << seam;
}

TEST(Elementary, SeamsKeepTheOrder) {
  // Halfway between multiples of ln 2, the power of two changes.
  for (const double n : {-1020.5, -100.5, -1.5, -0.5, 0.5, 1.5, 100.5, 1022.5}) {
    ExpectToGrowAcross(static_cast<double>(n * kLog2), kExp);
  }
  for (const double n : {0.5, 1.5, 2.5}) ExpectToGrowAcross(static_cast<double>(n * kLog2 / 2.0L), kTanh);
  for (const double eighths : {1.0, 3.0}) {
    ExpectToGrowAcross(static_cast<double>(std::tan(eighths * kPi / 8.0L)), kAtan);
  }
  // The bit pattern's exponent changes.
  for (const double x : {1.0, 2.0, 4.0, 8.0}) ExpectToGrowAcross(x, [](double v) { return -InverseCbrt(v); });
}

// Bit patterns of every kind, the numbers that laws meet, and the special ones with their neighbours.
std::vector<double> ArgumentsOfEveryKind() {
  std::mt19937_64 random(7);
  std::vector<double> numbers(100000);
  for (double& x : numbers) x = FromBits(random());
  for (const double x : Uniform(-50.0, 50.0, 100000)) numbers.push_back(x);
  for (const double x : Uniform(-2.0, 2.0, 100000)) numbers.push_back(x);
  for (const double x : {0.0, 5e-324, 1e-310, kSmallestNormal, 0.41421356237309503, 1.0, 2.414213562373095,
                         8.0, 22.0, 708.0, 709.78, 710.0, 1e300, kLargest, kInfinity, kNaN}) {
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
          << name << " of " << x[i + lane] << " and " << y[i + lane] << " in lane " << lane << " of " << N
          << ": " << result[lane] << " instead of " << expected;
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
  ExpectLanesEqualScalar<N>("Tanh", [](auto x, auto) { return Tanh(x); });
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
