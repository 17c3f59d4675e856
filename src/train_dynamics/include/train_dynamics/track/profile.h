#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A dip in the rail (paper Eq 7), or a hump where the depth is negative:
///
///   z_d(x) = (H/2) (1 - cos(2 pi x / L)),  0 <= x <= L,  positive down
struct DipParams {
  double from_m = kRequired;    ///< where x = 0
  double depth_m = kRequired;   ///< H
  double length_m = kRequired;  ///< L

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite);
    v.Number("depth_m", depth_m, Range{-1.0, 1.0, false, false});
    v.Number("length_m", length_m, kPositive);
  }
};

/// Height of the rail above its nominal line [m] and its slope [-].
template <class T>
struct RailHeight {
  T height, slope;
};

/// Rail height of one dip at a position along the track; continuous with its slope at both ends.
RailHeight<double> DipHeight(const DipParams& dip, double position_m);

}  // namespace train_dynamics
