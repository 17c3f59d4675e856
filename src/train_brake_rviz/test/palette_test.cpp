#include "train_brake_rviz/board/palette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>

namespace train_brake_rviz {

bool operator==(const Color& a, const Color& b) { return a.red == b.red && a.green == b.green && a.blue == b.blue; }
std::ostream& operator<<(std::ostream& stream, const Color& c) {
  return stream << c.red << ' ' << c.green << ' ' << c.blue;
}

namespace {

/// Lightness L* of CIE 1976, 0 black ... 100 white, of a colour given in sRGB.
double Lightness(Color color) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const double y = 0.2126 * linear(color.red) + 0.7152 * linear(color.green) + 0.0722 * linear(color.blue);
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(Palette, SequentialScaleDarkensEvenly) {
  constexpr int kSteps = 50;
  const double whole = Lightness(Sequential(0.0)) - Lightness(Sequential(1.0));
  EXPECT_GT(whole, 70.0);
  for (int i = 0; i < kSteps; ++i) {
    const double step = Lightness(Sequential(double(i) / kSteps)) - Lightness(Sequential(double(i + 1) / kSteps));
    EXPECT_GT(step, 0.3 * whole / kSteps) << i;
    EXPECT_LT(step, 2.0 * whole / kSteps) << i;
  }
}

TEST(Palette, DivergingScaleDarkensToBothEndsAlike) {
  for (double value = 0.0; value <= 1.0; value += 0.05) {
    // Within the lightness that an eye hardly tells apart in different hues.
    EXPECT_NEAR(Lightness(Diverging(-value)), Lightness(Diverging(value)), 8.0) << value;
  }
  for (double value = 0.0; value < 0.99; value += 0.05) {
    EXPECT_GT(Lightness(Diverging(value)), Lightness(Diverging(value + 0.05)));
    EXPECT_GT(Lightness(Diverging(-value)), Lightness(Diverging(-value - 0.05)));
  }
}

TEST(Palette, CompressionIsBlueAndTensionIsRed) {
  EXPECT_GT(Diverging(-0.6).blue, 2.0f * Diverging(-0.6).red);
  EXPECT_GT(Diverging(0.6).red, 2.0f * Diverging(0.6).blue);
}

TEST(Palette, WhatIsOutsideTakesTheEndAndWhatIsNoNumberIsGrey) {
  EXPECT_EQ(Diverging(1.0), Diverging(7.0));
  EXPECT_EQ(Diverging(-1.0), Diverging(-7.0));
  EXPECT_EQ(Sequential(0.0), Sequential(-0.1));
  const Color unknown = Sequential(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(unknown.red, unknown.green);
  EXPECT_EQ(unknown.green, unknown.blue);
}

}  // namespace
}  // namespace train_brake_rviz
