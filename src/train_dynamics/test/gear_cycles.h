#pragma once

#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "train_dynamics/coupler/connection.h"

namespace train_dynamics {

/// Work [J] that a connection takes up along a path of extensions, from a start at rest; trapezoids, at a rate that is
/// the same everywhere.
template <class Law>
double WorkAlong(const Law& law, const std::vector<double>& path_m, double rate_mps = 0.0) {
  auto memory = law.AtRest(path_m.front());
  double work_j = 0.0, last_n = ConnectionForce(law, path_m.front(), 0.0, memory).force;
  for (std::size_t i = 1; i < path_m.size(); ++i) {
    const double step_m = path_m[i] - path_m[i - 1];
    const double force_n = ConnectionForce(law, path_m[i], std::copysign(rate_mps, step_m), memory).force;
    work_j += 0.5 * (force_n + last_n) * step_m;
    last_n = force_n;
  }
  return work_j;
}

/// From one extension to another in equal steps, appended to a path.
inline void MoveTo(std::vector<double>& path_m, double to_m, int steps) {
  const double from_m = path_m.back();
  for (int i = 1; i <= steps; ++i) path_m.push_back(from_m + (to_m - from_m) * i / steps);
}

/// A random path that begins and ends at 0, through tension and compression.
inline std::vector<double> RandomPath(std::mt19937_64& random, double reach_m, int turns, int steps) {
  std::vector<double> path_m = {0.0};
  for (int turn = 0; turn < turns; ++turn) {
    MoveTo(path_m, std::uniform_real_distribution<>(-reach_m, reach_m)(random), steps);
  }
  MoveTo(path_m, 0.0, steps);
  return path_m;
}

/// Two free bodies of equal mass that meet head on with a relative speed, from the edge of the slack on.
struct Impact {
  double peak_n = 0.0,
         travel_m = 0.0;   ///< largest push, and how far the connection was pushed beyond the slack
  double speed_mps = 0.0;  ///< of parting
};

/// By leapfrog with steps of dt, forces at predicted middles.
template <class Law>
Impact Collide(const Law& law, double mass_kg, double speed_mps, double start_m, double dt) {
  Impact impact;
  auto memory = law.AtRest(start_m);
  double q = start_m, v = -speed_mps;
  for (int i = 0; i < 2000000; ++i) {
    const double force_n = ConnectionForce(law, q + 0.5 * dt * v, v, memory).force;
    impact.peak_n = std::max(impact.peak_n, -force_n);
    const double before = v;
    v -= dt * force_n * 2.0 / mass_kg;
    q += 0.5 * dt * (before + v);
    impact.travel_m = std::max(impact.travel_m, start_m - q);
    if (q >= start_m) break;
  }
  impact.speed_mps = v;
  return impact;
}

}  // namespace train_dynamics
