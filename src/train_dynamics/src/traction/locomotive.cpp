#include "train_dynamics/traction/locomotive.h"

#include <algorithm>

namespace train_dynamics {

bool TractionParams::Drives(int wheelset) const {
  return driven_wheelsets.empty() ||
         std::find(driven_wheelsets.begin(), driven_wheelsets.end(), wheelset + 1) != driven_wheelsets.end();
}

double WantedEffort(const TractionParams& p, const NotchCommand& command, double speed_mps, double driven_weight_n) {
  if (command.dynamic_brake_notch > 0.0 && p.dynamic_brake) {
    return -DynamicBrakeEffort(*p.dynamic_brake, command.dynamic_brake_notch, speed_mps);
  }
  if (command.dynamic_brake_notch > 0.0) return 0.0;
  return TractiveEffort(p.tractive_effort, command.throttle_notch, speed_mps, driven_weight_n);
}

}  // namespace train_dynamics
