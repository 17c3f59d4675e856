#pragma once

#include <array>
#include <cstddef>

namespace ltd_master {

/// Wall time of the last exchanges.
class ExchangeStatistics {
 public:
  void Add(double wall_s);

  /// The time that this share (0 ... 1) of the last exchanges did not exceed [s]; 0 without any.
  double Quantile(double share) const;

 private:
  static constexpr std::size_t kWindow = 4096;
  std::array<float, kWindow> wall_s_{};
  std::size_t count_ = 0;  ///< of all so far
};

}  // namespace ltd_master
