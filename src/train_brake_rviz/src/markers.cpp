#include "train_brake_rviz/markers.h"

namespace train_brake_rviz {
namespace {

using visualization_msgs::Marker;

/// The board stands upright: x to the right, z up, and the viewer at negative y.
geometry_msgs::Point PlaceOf(Point at, Layer layer) {
  constexpr double kBetweenLayers = 0.05;
  geometry_msgs::Point place;
  place.x = at.right;
  place.y = -kBetweenLayers * static_cast<int>(layer);
  place.z = at.up;
  return place;
}

std_msgs::ColorRGBA Opaque(Color color) {
  std_msgs::ColorRGBA rgba;
  rgba.r = color.red;
  rgba.g = color.green;
  rgba.b = color.blue;
  rgba.a = 1.0f;
  return rgba;
}

}  // namespace

void MarkerWriter::Append(const std::string& name, const Drawing& drawing, visualization_msgs::MarkerArray& out) {
  Marker shapes;
  shapes.ns = name;
  shapes.type = Marker::TRIANGLE_LIST;
  shapes.scale.x = shapes.scale.y = shapes.scale.z = 1.0;
  shapes.color = Opaque(palette::kInk);
  shapes.points.reserve(drawing.vertices().size());
  shapes.colors.reserve(drawing.vertices().size());
  for (const Vertex& vertex : drawing.vertices()) {
    shapes.points.push_back(PlaceOf(vertex.at, vertex.layer));
    shapes.colors.push_back(Opaque(vertex.color));
  }
  if (shapes.points.empty()) shapes.action = Marker::DELETE;
  Add(shapes, out);

  int id = 0;
  for (const Text& text : drawing.texts()) {
    Marker words;
    words.ns = name;
    words.id = ++id;
    words.type = Marker::TEXT_VIEW_FACING;
    words.pose.position = PlaceOf(text.at, text.layer);
    words.scale.z = text.height;
    words.text = text.words;
    words.color = Opaque(text.color);
    Add(words, out);
  }
  const int texts = id;
  while (id < texts_[name]) {
    Marker gone;
    gone.ns = name;
    gone.id = ++id;
    gone.action = Marker::DELETE;
    Add(gone, out);
  }
  texts_[name] = texts;
}

void MarkerWriter::Add(Marker marker, visualization_msgs::MarkerArray& out) {
  marker.header.frame_id = frame_;  // stamp 0: the newest
  marker.pose.orientation.w = 1.0;
  Marker& sent = sent_[{marker.ns, marker.id}];
  if (sent == marker) return;
  sent = marker;
  out.markers.push_back(std::move(marker));
}

}  // namespace train_brake_rviz
