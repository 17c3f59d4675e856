#include "train_dynamics/coupler/draft_gear.h"

#include "train_dynamics/numeric/trigonometry.h"

namespace train_dynamics {

double DraftGearParams::TanWedge() const {
  const SinCos phi = SinCosDegrees(wedge_angle_deg);
  return phi.sin / phi.cos;
}

}  // namespace train_dynamics
