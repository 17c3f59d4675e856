#include "ltd_master/exchange_statistics.h"

#include <algorithm>
#include <vector>

namespace ltd_master {

void ExchangeStatistics::Add(double wall_s) { wall_s_[count_++ % kWindow] = static_cast<float>(wall_s); }

double ExchangeStatistics::Quantile(double share) const {
  const std::size_t filled = std::min(count_, kWindow);
  if (filled == 0) return 0.0;
  std::vector<float> sorted(wall_s_.begin(), wall_s_.begin() + filled);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(filled - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace ltd_master
