#include "train_brake_rviz/board/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace train_brake_rviz {

double NiceCeiling(double value) {
  constexpr double kRounding = 1e-9;  // of the logarithm: 0.2 shall not become 0.5
  const double power = std::pow(10.0, std::floor(std::log10(value) + kRounding));
  for (double digit : {1.0, 2.0, 5.0}) {
    if (value <= digit * power * (1.0 + kRounding)) return digit * power;
  }
  return 10.0 * power;
}

double Axis::Clamped(double value) const { return (*this)(std::clamp(value, min, max)); }

std::vector<double> Axis::Ticks(int count) const {
  const double distance = NiceCeiling(0.7 * (max - min) / count);
  const double first = std::ceil(min / distance - 1e-6), last = std::floor(max / distance + 1e-6);
  std::vector<double> ticks;
  constexpr int kMost = 100;  // whatever the numbers are
  for (int i = 0; i <= last - first && i < kMost; ++i) ticks.push_back((first + i) * distance);
  return ticks;
}

std::string Rounded(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  const double unit = std::pow(10.0, -decimals);
  const bool is_zero = std::abs(value) < 0.5 * unit;
  return fmt::format("{:.{}f}", is_zero ? 0.0 : value, decimals);
}

std::string TickText(double value, double distance) {
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(distance) + 1e-6)));
  return Rounded(value, decimals);
}

void GrowingLimit::Include(double size) {
  if (std::isfinite(size) && size > limit_) limit_ = NiceCeiling(size);
}

}  // namespace train_brake_rviz
