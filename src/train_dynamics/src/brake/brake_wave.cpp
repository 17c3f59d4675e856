#include "train_dynamics/brake/brake_wave.h"

#include <cmath>
#include <limits>

namespace train_dynamics {

WaveArrival FirstWave(double command_s, double position_m, const std::vector<WaveSource>& sources,
                      double wave_speed_mps) {
  WaveArrival first{std::numeric_limits<double>::infinity(), 0.0};
  for (const WaveSource& source : sources) {
    const double distance_m = std::abs(position_m - source.position_m);
    const double time_s = command_s + source.delay_s + distance_m / wave_speed_mps;
    if (time_s < first.time_s) first = {time_s, distance_m};
  }
  return first;
}

}  // namespace train_dynamics
