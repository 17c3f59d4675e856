#pragma once

#include <cmath>

#include "train_brake_rviz/board/drawing.h"

namespace train_brake_rviz {

inline bool SameColor(Color a, Color b) { return a.red == b.red && a.green == b.green && a.blue == b.blue; }

/// Area of all triangles of one colour, overlaps counted twice.
inline double AreaOf(const Drawing& drawing, Color color) {
  double area = 0.0;
  const auto& v = drawing.vertices();
  for (size_t i = 0; i + 2 < v.size(); i += 3) {
    if (!SameColor(v[i].color, color)) continue;
    const double ar = v[i + 1].at.right - v[i].at.right, au = v[i + 1].at.up - v[i].at.up;
    const double br = v[i + 2].at.right - v[i].at.right, bu = v[i + 2].at.up - v[i].at.up;
    area += 0.5 * std::abs(ar * bu - au * br);
  }
  return area;
}

/// The smallest rectangle around all that has one colour.
inline Rectangle ExtentOf(const Drawing& drawing, Color color) {
  Rectangle extent = {1e9, -1e9, 1e9, -1e9};
  for (const Vertex& vertex : drawing.vertices()) {
    if (!SameColor(vertex.color, color)) continue;
    extent.left = std::fmin(extent.left, vertex.at.right);
    extent.right = std::fmax(extent.right, vertex.at.right);
    extent.bottom = std::fmin(extent.bottom, vertex.at.up);
    extent.top = std::fmax(extent.top, vertex.at.up);
  }
  return extent;
}

/// The rectangle that a text fills.
inline Rectangle ExtentOf(const Text& text) {
  const double half = 0.5 * text.height * TextWidth(text.words), up = 0.4 * text.height;
  return {text.at.right - half, text.at.right + half, text.at.up - up, text.at.up + up};
}

}  // namespace train_brake_rviz
