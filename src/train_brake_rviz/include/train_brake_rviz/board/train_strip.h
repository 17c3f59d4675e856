#pragma once

#include <vector>

#include "train_brake_rviz/board/along_train.h"
#include "train_brake_rviz/board/drawing.h"
#include "train_brake_rviz/board/elevation.h"

namespace train_brake_rviz {

/// The train on its track, seen from its left side: lengths to scale, vehicles much higher than they are, so
/// that they can be seen.
class TrainStrip {
 public:
  TrainStrip(const Rectangle& area, const Elevation& elevation, double vertical_exaggeration)
      : area_(area), elevation_(elevation), exaggeration_(vertical_exaggeration) {}

  void DrawTrack(Drawing& drawing, const Abscissa& abscissa) const;
  /// @param edge_m  see VehicleEdges
  /// @param color   [vehicle]
  void DrawVehicles(Drawing& drawing, const Abscissa& abscissa, const std::vector<double>& edge_m,
                    const std::vector<Color>& color) const;
  /// A mark over vehicles that are not like the others, and their name where it does not lie over that of one in front.
  /// @param edge_m       see VehicleEdges
  /// @param locomotives  their indices, ascending
  void DrawLocomotives(Drawing& drawing, const Abscissa& abscissa, const std::vector<double>& edge_m,
                       const std::vector<int>& locomotives) const;
  /// Outline of one vehicle, and lines from there to a close-up of it.
  void DrawZoom(Drawing& drawing, const Abscissa& abscissa, double front_m, double rear_m,
                const Rectangle& close_up) const;

  /// Height on the board of the rail at a position.
  double Rail(const Abscissa& abscissa, double position_m) const;

  static constexpr double kVehicleHeight = 4.0;  ///< on the board
  /// Height on the board that grades and dips may take.
  static double RoomForTrack(const Rectangle& area);

 private:
  Rectangle area_;
  const Elevation& elevation_;
  double exaggeration_;
};

}  // namespace train_brake_rviz
