#pragma once

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A dip in the rail (paper Eq 7), or a hump where the depth is negative:
///
///   z_d(x) = (H/2) (1 - cos(2 pi x / L)),  0 <= x <= L,  positive down
struct DipParams {
  double from_m = kRequired;
  double depth_m = kRequired;
  double length_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite, "position at which the dip begins");
    v.Number("depth_m", depth_m, Range{-1.0, 1.0, false, false}, "H, depth in the middle of the dip; negative: a hump");
    v.Number("length_m", length_m, kPositive, "L, length of the dip: z = (H / 2) (1 - cos(2 pi x / L))");
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
