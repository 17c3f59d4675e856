#include "train_dynamics/track/pieces.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace train_dynamics {

Pieces::Pieces(std::vector<double> cuts_m) : bounds_(std::move(cuts_m)) {
  std::sort(bounds_.begin(), bounds_.end());
  bounds_.erase(std::unique(bounds_.begin(), bounds_.end()), bounds_.end());
  const std::size_t cuts = bounds_.size(), cells = 2 * cuts + 1;
  if (cuts > 0) {
    first_m_ = bounds_.front();
    cells_per_m_ = static_cast<double>(cells) / (bounds_.back() - first_m_);  // one cut: infinite
  }
  first_in_cell_.assign(cells + 1, 0);
  for (const double cut : bounds_) ++first_in_cell_[CellOf(cut) + 1];
  for (std::size_t cell = 0; cell < cells; ++cell) first_in_cell_[cell + 1] += first_in_cell_[cell];
  bounds_.insert(bounds_.begin(), Stretch().from_m);
  bounds_.push_back(Stretch().to_m);
}

/// Rises monotonically with the position, to the last bit, as do subtraction and multiplication by a number >= 0. A cut
/// of an earlier cell therefore lies before the position, one of a later cell behind it.
int Pieces::CellOf(double position_m) const {
  const double cell = (position_m - first_m_) * cells_per_m_;
  if (!(cell > 0.0)) return 0;
  const auto last = static_cast<double>(first_in_cell_.size() - 2);
  return static_cast<int>(cell < last ? cell : last);
}

int Pieces::NumberAt(double position_m) const {
  const int cell = CellOf(position_m);
  const auto cuts = bounds_.begin() + 1;
  const auto begin = cuts + first_in_cell_[cell], end = cuts + first_in_cell_[cell + 1];
  return static_cast<int>(std::upper_bound(begin, end, position_m) - cuts);
}

}  // namespace train_dynamics
