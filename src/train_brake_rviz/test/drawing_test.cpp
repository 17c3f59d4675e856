#include "train_brake_rviz/board/drawing.h"

#include <gtest/gtest.h>

#include "area.h"

namespace train_brake_rviz {
namespace {

constexpr Color kRed = Rgb(0xff0000);

TEST(Drawing, AreasAreThoseOfTheShapes) {
  Drawing box, disc, line;
  box.Box({1.0, 4.0, 2.0, 3.5}, kRed);
  EXPECT_DOUBLE_EQ(4.5, AreaOf(box, kRed));
  disc.Disc({5.0, 5.0}, 2.0, kRed);
  EXPECT_NEAR(M_PI * 4.0, AreaOf(disc, kRed), 0.01 * M_PI * 4.0);  // 32 corners: 0.6 % less
  line.Line({0.0, 0.0}, {3.0, 4.0}, 0.2, kRed);
  EXPECT_NEAR(0.2 * (5.0 + 0.2), AreaOf(line, kRed), 1e-12);  // square ends
}

TEST(Drawing, AnArrowReachesFromTailToHead) {
  for (const Point head : {Point{7.0, 0.0}, Point{-7.0, 0.0}, Point{0.2, 0.0}}) {  // the last is all head
    Drawing drawing;
    drawing.Arrow({0.0, 0.0}, head, 0.5, kRed);
    const Rectangle extent = ExtentOf(drawing, kRed);
    EXPECT_NEAR(std::fmin(0.0, head.right), extent.left, 1e-12);
    EXPECT_NEAR(std::fmax(0.0, head.right), extent.right, 1e-12);
    EXPECT_NEAR(-extent.bottom, extent.top, 1e-12);
  }
  Drawing nothing;
  nothing.Arrow({1.0, 1.0}, {1.0, 1.0}, 0.5, kRed);
  nothing.Line({1.0, 1.0}, {1.0, 1.0}, 0.5, kRed);
  EXPECT_TRUE(nothing.vertices().empty());
}

TEST(Drawing, TextsStandWhereTheyAreAligned) {
  Drawing drawing;
  for (const Align align : {Align::kLeft, Align::kCentre, Align::kRight}) {
    drawing.Write({50.0, 10.0}, align, 2.0, "speed 80 km/h");
  }
  EXPECT_NEAR(50.0, ExtentOf(drawing.texts()[0]).left, 1e-12);
  EXPECT_NEAR(50.0, drawing.texts()[1].at.right, 1e-12);
  EXPECT_NEAR(50.0, ExtentOf(drawing.texts()[2]).right, 1e-12);
}

TEST(TextWidth, AddsUpSignBySign) {
  EXPECT_DOUBLE_EQ(0.0, TextWidth(""));
  EXPECT_DOUBLE_EQ(TextWidth("km") + TextWidth("/h"), TextWidth("km/h"));
  EXPECT_DOUBLE_EQ(4.0 * TextWidth("0"), TextWidth("1969"));  // digits are equally wide: numbers do not dance
  const std::string square = "²";                             // two bytes, one sign
  EXPECT_DOUBLE_EQ(2.0 * TextWidth(square), TextWidth(square + square));
  EXPECT_LT(TextWidth("l"), TextWidth("W"));
}

}  // namespace
}  // namespace train_brake_rviz
