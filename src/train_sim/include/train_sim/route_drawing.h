#pragma once

#include <string>

#include "train_dynamics/track/track.h"

namespace train_sim {

/// A drawing of a route as the text of an SVG file: height, grade, curvature, speed limit and friction over the
/// position, as far as the route has them, and its stations.
std::string DrawRoute(const train_dynamics::TrackParams& route);

/// Where a route begins and ends: its extent or, where that is infinite, a little more than all its entries.
train_dynamics::Stretch DrawnExtent(const train_dynamics::TrackParams& route);

/// The height of the rail [m] along the route, from its grades: 0 at `begin_m`, or as given by its heights.
class RouteHeight {
 public:
  RouteHeight(const train_dynamics::TrackParams& route, double begin_m);
  double operator()(double position_m) const;

 private:
  std::vector<train_dynamics::StepValue> grades_;
  std::vector<double> height_m_;  ///< [grade] where it begins
  double shift_m_ = 0.0;
};

}  // namespace train_sim
