#pragma once

#include <limits>
#include <vector>

namespace train_dynamics {

/// A stretch of the track: [from_m, to_m), and where `to_m` is infinite all that lies behind `from_m`.
struct Stretch {
  double from_m = -std::numeric_limits<double>::infinity();
  double to_m = std::numeric_limits<double>::infinity();
};

/// The track cut into pieces, so that what depends on the position is kept as one value per piece.
///
/// Piece 0 lies before the first cut, piece i on [cut i - 1, cut i), the last piece behind the last cut. A position is
/// looked up in a time that does not grow with the number of cuts as long as they are spread over the track: equal
/// cells, two per cut, give the cuts to compare a position with. Many cuts in one cell are searched by bisection.
///
/// A look-up depends on the position only and remembers nothing: in any order and direction of look-ups, the answer is
/// the same.
class Pieces {
 public:
  Pieces() : Pieces(std::vector<double>()) {}
  /// @param cuts_m  finite; in any order, equal ones count once
  explicit Pieces(std::vector<double> cuts_m);

  int count() const { return static_cast<int>(bounds_.size()) - 1; }
  /// The number of the piece in which a position lies. (For NaN it is one of them.)
  int NumberAt(double position_m) const;
  Stretch operator[](int piece) const { return {bounds_[piece], bounds_[piece + 1]}; }

 private:
  int CellOf(double position_m) const;

  std::vector<double> bounds_;  ///< the cuts, between -infinity and infinity
  double first_m_ = 0.0;        ///< where the first cell begins
  double cells_per_m_ = 0.0;
  std::vector<int> first_in_cell_;  ///< [cell] the number of cuts in the cells before; one more at the end
};

}  // namespace train_dynamics
