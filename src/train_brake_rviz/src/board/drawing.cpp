#include "train_brake_rviz/board/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace train_brake_rviz {
namespace {

Point operator+(Point a, Point b) { return {a.right + b.right, a.up + b.up}; }
Point operator-(Point a, Point b) { return {a.right - b.right, a.up - b.up}; }
Point operator*(double k, Point a) { return {k * a.right, k * a.up}; }

double Length(Point a) { return std::hypot(a.right, a.up); }
Point LeftOf(Point a) { return {-a.up, a.right}; }

/// Advance widths of ' ' ... '~' in Liberation Sans (the same as in Arial and Helvetica), thousandths of an em.
constexpr std::array<short, 95> kAdvance = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

}  // namespace

double TextWidth(const std::string& words) {
  constexpr double kEm = 0.843;  // of a line's height, as rviz sets this font
  constexpr short kBlank = 667;  // rviz gives a blank the width of an A
  constexpr short kOther = 400;  // signs beyond ASCII, such as the square
  int thousandths = 0;
  for (const char letter : words) {
    const auto code = static_cast<unsigned char>(letter);
    const bool continues = (code & 0xc0) == 0x80;  // of a sign that has several bytes in UTF-8
    if (continues) continue;
    const bool known = code > ' ' && code < ' ' + kAdvance.size();
    thousandths += known ? kAdvance[code - ' '] : code == ' ' ? kBlank : kOther;
  }
  return 1e-3 * kEm * thousandths;
}

void Drawing::Triangle(Point a, Point b, Point c, Color color) {
  for (const Point& p : {a, b, c}) vertices_.push_back({p, layer_, color});
}

void Drawing::Polygon(const std::vector<Point>& corners, Color color) {
  for (size_t i = 2; i < corners.size(); ++i) Triangle(corners[0], corners[i - 1], corners[i], color);
}

void Drawing::Box(const Rectangle& box, Color color) {
  Polygon({{box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}}, color);
}

void Drawing::Frame(const Rectangle& box, double width, Color color) {
  Polyline({{box.left, box.bottom},
            {box.right, box.bottom},
            {box.right, box.top},
            {box.left, box.top},
            {box.left, box.bottom}},
           width, color);
}

void Drawing::Line(Point a, Point b, double width, Color color) {
  const double length = Length(b - a);
  if (length == 0.0) return;
  const Point along = 0.5 * width / length * (b - a), aside = LeftOf(along);
  const Point begin = a - along, end = b + along;  // square ends, so that corners close
  Polygon({begin - aside, end - aside, end + aside, begin + aside}, color);
}

void Drawing::Polyline(const std::vector<Point>& points, double width, Color color) {
  for (size_t i = 1; i < points.size(); ++i) Line(points[i - 1], points[i], width, color);
}

void Drawing::Disc(Point centre, double radius, Color color) {
  constexpr int kCorners = 32;
  std::vector<Point> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * M_PI * i / kCorners;
    corners.push_back(centre + radius * Point{std::cos(angle), std::sin(angle)});
  }
  Polygon(corners, color);
}

void Drawing::Arrow(Point tail, Point head, double width, Color color) {
  constexpr double kHeadLength = 2.5, kHeadWidth = 3.0;  // of the shaft's width
  const double length = Length(head - tail);
  if (length == 0.0) return;
  const Point along = 1.0 / length * (head - tail), aside = LeftOf(along);
  const double head_length = std::min(kHeadLength * width, length);
  const double head_width = kHeadWidth / kHeadLength * head_length;
  const Point neck = head - head_length * along;
  Triangle(neck - 0.5 * head_width * aside, head, neck + 0.5 * head_width * aside, color);
  if (length <= head_length) return;
  const Point half = 0.5 * width * aside;
  Polygon({tail - half, neck - half, neck + half, tail + half}, color);
}

void Drawing::Write(Point at, Align align, double height, const std::string& words, Color color) {
  const double half = 0.5 * height * TextWidth(words);
  if (align == Align::kLeft) at.right += half;
  if (align == Align::kRight) at.right -= half;
  texts_.push_back({at, Layer::kTop, words, height, color});
}

}  // namespace train_brake_rviz
