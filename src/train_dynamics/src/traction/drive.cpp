#include "train_dynamics/traction/drive.h"

#include <cmath>

#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

void StepDrive(const DriveParams& p, double wanted_n, double dt, DriveState& state) {
  const double side = wanted_n > 0.0 ? 1.0 : wanted_n < 0.0 ? -1.0 : 0.0;
  const bool changes_side = side != 0.0 && state.side != 0.0 && side != state.side;
  // Half a step: sums of steps miss the whole by rounding.
  const bool has_waited = state.effort_n == 0.0 && state.at_zero_s + 0.5 * dt >= p.changeover_s;
  const bool may_work = !changes_side || has_waited;
  const double before_n = std::abs(state.effort_n);
  const double wanted_size_n = may_work ? std::abs(wanted_n) : 0.0;
  const double size_n = Clamp(wanted_size_n, before_n - p.fall_rate_n_per_s * dt, before_n + p.rise_rate_n_per_s * dt);
  if (may_work && side != 0.0) state.side = side;
  state.at_zero_s = size_n == 0.0 && before_n == 0.0 ? state.at_zero_s + dt : 0.0;
  state.effort_n = state.side * size_n;
}

}  // namespace train_dynamics
