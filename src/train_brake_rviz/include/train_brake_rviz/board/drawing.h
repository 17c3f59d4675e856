#pragma once

#include <string>
#include <vector>

#include "train_brake_rviz/board/palette.h"

namespace train_brake_rviz {

/// A place on the board. One unit is about the height of a small letter; see board.h for the board's size.
struct Point {
  double right, up;
};

struct Rectangle {
  double left, right, bottom, top;

  double width() const { return right - left; }
  double height() const { return top - bottom; }
  Point Centre() const { return {0.5 * (left + right), 0.5 * (bottom + top)}; }
};

/// What lies over what: later ones are nearer to the viewer.
enum class Layer { kBeam, kBack, kFill, kLine, kFront, kTop };

struct Vertex {
  Point at;
  Layer layer;
  Color color;
};

enum class Align { kLeft, kCentre, kRight };

struct Text {
  Point at;  ///< centre of the text
  Layer layer;
  std::string words;
  double height;  ///< of a line; a capital letter has 0.62 of it
  Color color;
};

/// Width of a line of text as rviz sets it, in units of its height: Liberation Sans, wide blanks.
double TextWidth(const std::string& words);

/// Coloured shapes and texts, independent of how they are displayed. All that has an area is made of triangles, three
/// vertices each.
class Drawing {
 public:
  /// The layer of what is drawn from now on.
  void On(Layer layer) { layer_ = layer; }

  void Triangle(Point a, Point b, Point c, Color color);
  /// Corners in order, either way round; convex.
  void Polygon(const std::vector<Point>& corners, Color color);
  void Box(const Rectangle& box, Color color);
  void Frame(const Rectangle& box, double width, Color color);
  void Line(Point a, Point b, double width, Color color);
  void Polyline(const std::vector<Point>& points, double width, Color color);
  void Disc(Point centre, double radius, Color color);
  /// A straight arrow; nothing where it would have no length. Short ones are all head.
  void Arrow(Point tail, Point head, double width, Color color);
  /// @param at  left end, centre or right end of the line, half-way up
  void Write(Point at, Align align, double height, const std::string& words, Color color = palette::kInk);

  const std::vector<Vertex>& vertices() const { return vertices_; }
  const std::vector<Text>& texts() const { return texts_; }

 private:
  Layer layer_ = Layer::kFill;
  std::vector<Vertex> vertices_;
  std::vector<Text> texts_;
};

}  // namespace train_brake_rviz
