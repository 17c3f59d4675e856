#include "train_brake_rviz/board/elevation.h"

#include <algorithm>
#include <cmath>

namespace train_brake_rviz {
Elevation::Elevation(const train_dynamics::TrackParams& track) : track_(track), grades_(track.Grades()) {
  for (size_t i = 0; i < grades_.size(); ++i) {
    height_m_.push_back(i == 0 ? 0.0
                               : height_m_[i - 1] + grades_[i - 1].value * (grades_[i].from_m - grades_[i - 1].from_m));
  }
  const double at_zero = (*this)(0.0) - train_dynamics::RailHeightAt(track_, 0.0).height;
  for (double& height : height_m_) height -= at_zero;
}

double Elevation::operator()(double position_m) const {
  const double dips = train_dynamics::RailHeightAt(track_, position_m).height;
  if (grades_.empty()) return dips;
  const auto next = std::upper_bound(grades_.begin(), grades_.end(), position_m,
                                     [](double s, const auto& grade) { return s < grade.from_m; });
  const size_t i = next == grades_.begin() ? 0 : static_cast<size_t>(next - grades_.begin() - 1);
  return dips + height_m_[i] + grades_[i].value * (position_m - grades_[i].from_m);
}

double FittingExaggeration(const Elevation& elevation, double begin_m, double end_m, double window_m, double scale,
                           double room) {
  constexpr int kPerWindow = 400, kMostSamples = 20000;
  const double length = end_m - begin_m + window_m;
  const double step = std::max(window_m / kPerWindow, length / kMostSamples);
  std::vector<double> height;
  for (int i = 0; i * step <= length; ++i) height.push_back(elevation(begin_m + i * step));

  const auto per_window = static_cast<size_t>(std::ceil(window_m / step)) + 1;
  double range = 0.0;
  for (size_t i = 0; i < height.size(); i += std::max<size_t>(1, per_window / 8)) {
    const auto begin = height.begin() + static_cast<long>(i);
    const auto end = height.begin() + static_cast<long>(std::min(i + per_window, height.size()));
    const auto [lowest, highest] = std::minmax_element(begin, end);
    range = std::max(range, *highest - *lowest);
  }
  for (double exaggeration : {100.0, 50.0, 20.0, 10.0, 5.0, 2.0}) {
    if (exaggeration * range * scale <= room) return exaggeration;
  }
  return 1.0;
}

}  // namespace train_brake_rviz
