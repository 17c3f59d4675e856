#pragma once

#include <array>
#include <cstddef>

namespace ltd_master {

/// Wall time of the last exchanges.
class ExchangeStatistics {
 public:
  void Add(double wall_s);

  /// Quantile of the wall time of the last exchanges [s]: a share of them (0 ... 1) took no longer; 0 before the first.
  double Quantile(double share) const;

 private:
  static constexpr std::size_t kWindow = 4096;
  std::array<float, kWindow> wall_s_{};
  std::size_t count_ = 0;  ///< of all so far
};

}  // namespace ltd_master
