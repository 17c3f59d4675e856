#pragma once

#include <string>
#include <vector>

#include "train_brake_rviz/board/axis.h"
#include "train_brake_rviz/board/drawing.h"

/// What is drawn over the length of the train: the train itself, its track and plots share one abscissa.
namespace train_brake_rviz {

/// From positions along the track to the board. The train travels to the left, so that its first vehicle is where plots
/// begin.
struct Abscissa {
  double head_m;  ///< position that is drawn at the left end
  double left;    ///< end on the board
  double scale;   ///< board units per metre

  double operator()(double position_m) const { return left + (head_m - position_m) * scale; }
};

/// Positions where one vehicle's place ends and the next one's begins, from the front: n + 1 for n vehicles,
/// half-way between their centres.
std::vector<double> VehicleEdges(const std::vector<double>& centre_m, double first_length_m, double last_length_m);

/// A plot over the train.
class AlongPlot {
 public:
  AlongPlot(const Rectangle& area, const Axis& values, const Abscissa& abscissa)
      : area_(area), values_(values), abscissa_(abscissa) {}

  /// Frame, horizontal grid with numbers and title; vertical lines at the given positions.
  void DrawAxes(Drawing& drawing, const std::string& title, const std::vector<double>& grid_m) const;

  /// Bar i from low[i] to high[i] between the positions edge_m[i] and edge_m[i + 1]. Bars touch, so that they
  /// make an area. What is not finite is left out.
  void DrawBars(Drawing& drawing, const std::vector<double>& edge_m, const std::vector<double>& low,
                const std::vector<double>& high, Color color) const;

 private:
  Rectangle area_;
  Axis values_;
  Abscissa abscissa_;
};

}  // namespace train_brake_rviz
