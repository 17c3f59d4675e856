#include "train_dynamics/brake/pressure_table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace train_dynamics {

PressureTable::PressureTable(std::vector<double> time_s, std::vector<std::vector<double>> pressure_pa)
    : time_s_(std::move(time_s)), pressure_pa_(std::move(pressure_pa)) {
  if (time_s_.empty()) throw std::invalid_argument("a pressure table must have at least one row");
  const auto all_finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  if (!all_finite(time_s_) ||
      std::adjacent_find(time_s_.begin(), time_s_.end(), std::greater_equal<>()) != time_s_.end()) {
    throw std::invalid_argument("the times of a pressure table must be finite and ascend");
  }
  for (size_t i = 0; i < pressure_pa_.size(); ++i) {
    const std::vector<double>& column = pressure_pa_[i];
    if (column.size() != time_s_.size()) throw std::invalid_argument("a pressure table must be rectangular");
    if (!all_finite(column) || *std::min_element(column.begin(), column.end()) < 0.0) {
      throw std::invalid_argument("the pressures of vehicle " + std::to_string(i + 1) + " must be finite and >= 0");
    }
  }
}

void PressureTable::PressuresAt(double time_s, std::vector<double>& pressure_pa) const {
  pressure_pa.resize(pressure_pa_.size());
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  const size_t last = time_s_.size() - 1;
  const size_t high = std::min<size_t>(after - time_s_.begin(), last);
  const size_t low = after == time_s_.begin() ? 0 : std::min<size_t>(after - time_s_.begin() - 1, last);
  const double span = time_s_[high] - time_s_[low];
  const double weight = span > 0.0 ? (time_s - time_s_[low]) / span : 0.0;
  for (size_t i = 0; i < pressure_pa_.size(); ++i) {
    pressure_pa[i] = pressure_pa_[i][low] + weight * (pressure_pa_[i][high] - pressure_pa_[i][low]);
  }
}

}  // namespace train_dynamics
