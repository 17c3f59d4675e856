#pragma once

namespace train_dynamics {

/// Braked-weight percentage lambda [%] of a vehicle that stops alone, emergency, P, level, from 100 or 120 km/h over s
/// [m]:
///
///   s = 61300 / (lambda + 8.9)  at 100 km/h,   s = 83634 / (lambda + 8.8)  at 120 km/h        (UIC 544-1 [M])
///
/// @throws std::invalid_argument for other speeds
double BrakedWeightPercentage(double speed_kmh, double stopping_distance_m);

/// Braking position of a train in ETCS's conversion model.
enum class BrakingPosition { kPassenger, kGoods };

/// Stopping distance [m] of an emergency in the conversion model of ETCS (SUBSET-026, A.3.7 to A.3.9 [S]), level track:
///
///   s = v T + integral of v dv / A(v),   A = 0.0075 lambda + 0.076 m/s2 up to 16.85 lambda^0.428 km/h,
///
/// above it a cubic of lambda for each range of speed; build-up time T = a + b l + c l^2 of a freight train, l = L /
/// 100 m.
///
/// @param lambda  [%], 30 to 250     @param length_m  of the train, to 1500
/// @throws std::invalid_argument outside these ranges, or above 200 km/h
double EtcsStoppingDistance(double lambda, double length_m, double speed_kmh, BrakingPosition position);

}  // namespace train_dynamics
