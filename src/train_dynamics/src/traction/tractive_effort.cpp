#include "train_dynamics/traction/tractive_effort.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

double NotchShare(const std::vector<double>& shares, double notch) {
  const double last = static_cast<double>(shares.size());
  const double at = Clamp(notch, 0.0, last);
  if (at == last) return shares.back();
  const auto above = static_cast<std::size_t>(at);
  const double from = above == 0 ? 0.0 : shares[above - 1];
  return from + (at - static_cast<double>(above)) * (shares[above] - from);
}

double EffortTableParams::At(double speed_mps) const {
  const double k = 3.6 * speed_mps;
  if (k > speed_kmh.back()) return effort_n.back() * (speed_kmh.back() / k);
  return InterpolateLinearly(speed_kmh, effort_n, k);
}

double EffortTableParams::LargestPower() const {
  double largest = speed_kmh.back() * effort_n.back();
  for (std::size_t i = 1; i < speed_kmh.size(); ++i) {
    const double slope = (effort_n[i] - effort_n[i - 1]) / (speed_kmh[i] - speed_kmh[i - 1]);
    // k (F + slope (k - k_i)) is largest where its derivative vanishes.
    const double top =
        slope < 0.0 ? 0.5 * (speed_kmh[i] - effort_n[i] / slope) : std::numeric_limits<double>::infinity();
    const double k = Clamp(top, speed_kmh[i - 1], speed_kmh[i]);
    largest = Max(largest, k * (effort_n[i] + slope * (k - speed_kmh[i])));
  }
  return largest / 3.6;
}

double TractiveEffort(const TractiveEffortParams& p, double notch, double speed_mps, double driven_weight_n) {
  const double v = std::abs(speed_mps);
  double effort_n = NotchShare(p.throttle.effort_share, notch) * p.starting_effort_n;
  effort_n = Min(effort_n, NotchShare(p.throttle.power_share, notch) * p.rim_power_w / Max(v, kLeastPowerSpeed));
  effort_n = Min(effort_n, UsableAdhesion(p.usable_adhesion, v) * driven_weight_n);
  if (p.table) effort_n = Min(effort_n, p.table->At(v));
  return effort_n;
}

}  // namespace train_dynamics
