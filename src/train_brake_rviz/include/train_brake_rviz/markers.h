#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>

#include "train_brake_rviz/board/drawing.h"

namespace train_brake_rviz {

/// Turns drawings into markers for rviz, and leaves out what has not changed since it was sent last.
class MarkerWriter {
 public:
  explicit MarkerWriter(std::string frame) : frame_(std::move(frame)) {}

  /// Appends the drawing's markers, one list of triangles and the texts, in a namespace of their own.
  void Append(const std::string& name, const Drawing& drawing, visualization_msgs::MarkerArray& out);

  /// Sends everything again next time: a display may have been added late or cleared.
  void Refresh() { sent_.clear(); }

 private:
  void Add(visualization_msgs::Marker marker, visualization_msgs::MarkerArray& out);

  std::string frame_;
  std::map<std::pair<std::string, int>, visualization_msgs::Marker> sent_;  ///< by namespace and id
  std::map<std::string, int> texts_;  ///< [namespace] how many there are on the screen
};

}  // namespace train_brake_rviz
