#pragma once

#include <vector>

namespace train_dynamics {

/// A place where the pressure of the brake pipe changes after a command.
struct WaveSource {
  double position_m;  ///< on the unstretched train
  double delay_s;     ///< from the command to the change of pressure here
};

/// When a wave in the brake pipe arrives, and how far it has come.
struct WaveArrival {
  double time_s;  ///< infinity without sources
  double distance_m;
};

/// The arrival of the first wave in the brake pipe after a command at time t [s] (paper Eq 2):
///
///   t_d = t + min over sources (delay + distance / wave speed)
///
/// If waves arrive together, the distance is that of the source listed first.
///
/// @param position_m  of the vehicle's centre on the unstretched train, the same axis as the sources'
/// @param wave_speed_mps  > 0
WaveArrival FirstWave(double command_s, double position_m, const std::vector<WaveSource>& sources,
                      double wave_speed_mps);

}  // namespace train_dynamics
