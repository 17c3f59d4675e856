#include "train_dynamics/numeric/elementary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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
void ExpectErrorBelow(double bound_ulp, Function function, Reference reference, const std::vector<double>& arguments) {
  for (const double x : arguments) {
    const long double exact = reference(static_cast<long double>(x));
    const double error_ulp = static_cast<double>(std::abs(function(x) - exact)) / Ulp(exact);
    ASSERT_LT(error_ulp, bound_ulp + kReferenceError) << "at " << x;
  }
}

long double ExactExp(long double x) { return std::exp(x); }
long double ExactAtan(long double x) { return std::atan(x); }
long double ExactInverseCbrt(long double x) { return 1.0L / std::cbrt(x); }

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

TEST(Decay, RelativeErrorIsBelow2em12) {
  for (const std::vector<double>& arguments : {Uniform(0.0, 700.0), Uniform(0.0, 1.0), Logarithmic(-1000.0, 0.0)}) {
    for (const double x : arguments) {
      const long double exact = std::exp(-static_cast<long double>(x));
      ASSERT_LT(std::abs(Decay(x) - exact), 2e-12L * exact) << x;
      ASSERT_LE(Decay(x), 1.0) << x;
    }
  }
}

TEST(Decay, EndsOfItsRange) {
  static_assert(Decay(0.0) == 1.0 && Decay(-0.0) == 1.0);
  for (const double x : {700.0, 701.0, 1e300, kInfinity}) {
    EXPECT_EQ(Decay(x), Decay(700.0)) << x;
    EXPECT_GT(Decay(x), kSmallestNormal) << x;
  }
}

TEST(Atan, ErrorIsBelowTwoUlp) {
  ExpectErrorBelow(2.0, kAtan, ExactAtan, Uniform(0.0, 3.0));
  ExpectErrorBelow(2.0, kAtan, ExactAtan, Logarithmic(-1000.0, 1000.0));
}

TEST(Atan, LimitsAreExact) {
  EXPECT_EQ(Atan(1.0), static_cast<double>(kPi / 4.0L));
  for (const double x : {1e17, 1e300, kLargest, kInfinity}) EXPECT_EQ(Atan(x), static_cast<double>(kPi / 2.0L)) << x;
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
    ASSERT_EQ(Atan(-x), -Atan(x)) << x;
  }
  EXPECT_TRUE(std::signbit(Atan(-0.0)));
}

TEST(Elementary, NaNIsNotHidden) {
  for (const double nan : {kNaN, -kNaN}) {
    EXPECT_TRUE(std::isnan(Exp(nan)));
    EXPECT_TRUE(std::isnan(Decay(nan)));
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
  for (const double eighths : {1.0, 3.0}) {
    ExpectToGrowAcross(static_cast<double>(std::tan(eighths * kPi / 8.0L)), kAtan);
  }
  // The bit pattern's exponent changes.
  for (const double x : {1.0, 2.0, 4.0, 8.0}) ExpectToGrowAcross(x, [](double v) { return -InverseCbrt(v); });
}

}  // namespace
}  // namespace train_dynamics
