#include "train_dynamics/train/braked_weight.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace train_dynamics {
namespace {

// Coefficients of lambda^0..3 of the deceleration above the limit speed, from SUBSET-026 A.3.7 [S].
constexpr double kTo100[] = {0.0663, 4.72e-3, 6.1e-5, -6.3e-7};
constexpr double kTo120[] = {0.13, 5.14e-3, -4.54e-6, 2.73e-7};
constexpr double kTo150[] = {0.0479, 5.81e-3, -6.76e-6, 5.58e-8};
constexpr double kTo180[] = {0.048, 5.52e-3, -3.85e-6, 3.0e-8};
constexpr double kAbove180[] = {0.0559, 5.06e-3, 1.66e-6, 3.23e-9};

double Deceleration(double lambda, double speed_kmh) {
  if (speed_kmh <= 16.85 * std::pow(lambda, 0.428)) return 0.0075 * lambda + 0.076;
  const double* a = speed_kmh <= 100.0   ? kTo100
                    : speed_kmh <= 120.0 ? kTo120
                    : speed_kmh <= 150.0 ? kTo150
                    : speed_kmh <= 180.0 ? kTo180
                                         : kAbove180;
  return a[0] + lambda * (a[1] + lambda * (a[2] + lambda * a[3]));
}

double BuildUpTime(double length_m, BrakingPosition position) {
  const double l = std::max(400.0, length_m) / 100.0;
  if (position == BrakingPosition::kPassenger)
    return length_m <= 900.0 ? 2.3 + 0.17 * l * l : -0.5 + 1.6 * l + 0.03 * l * l;
  const double of_goods = length_m / 100.0;
  return length_m <= 900.0 ? 12.0 + 0.05 * of_goods * of_goods : -0.4 + 1.6 * of_goods + 0.03 * of_goods * of_goods;
}

}  // namespace

double BrakedWeightPercentage(double speed_kmh, double stopping_distance_m) {
  if (speed_kmh == 100.0) return 61300.0 / stopping_distance_m - 8.9;
  if (speed_kmh == 120.0) return 83634.0 / stopping_distance_m - 8.8;
  throw std::invalid_argument("braked weight is defined for stops from 100 or 120 km/h, not from " +
                              std::to_string(speed_kmh));
}

double EtcsStoppingDistance(double lambda, double length_m, double speed_kmh, BrakingPosition position) {
  if (!(lambda >= 30.0 && lambda <= 250.0))
    throw std::invalid_argument("the conversion model of ETCS holds for braked weights of 30 to 250 %, not " +
                                std::to_string(lambda));
  if (!(length_m > 0.0 && length_m <= 1500.0))
    throw std::invalid_argument("the conversion model of ETCS holds for trains up to 1500 m, not " +
                                std::to_string(length_m));
  if (!(speed_kmh >= 0.0 && speed_kmh <= 200.0))
    throw std::invalid_argument("the conversion model of ETCS holds up to 200 km/h, not " + std::to_string(speed_kmh));
  double distance_m = speed_kmh / 3.6 * BuildUpTime(length_m, position);
  constexpr int kSteps = 20000;  // middles of equal steps of the speed: jumps of A cost 1e-4 of a step
  const double dv = speed_kmh / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double v_kmh = (i + 0.5) * dv;
    distance_m += v_kmh / 3.6 * (dv / 3.6) / Deceleration(lambda, v_kmh);
  }
  return distance_m;
}

}  // namespace train_dynamics
