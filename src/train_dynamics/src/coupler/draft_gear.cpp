#include "train_dynamics/coupler/draft_gear.h"

#include <algorithm>

#include "train_dynamics/numeric/trigonometry.h"

namespace train_dynamics {

double DraftGearParams::TanWedge() const {
  const SinCos phi = SinCosDegrees(wedge_angle_deg);
  return phi.sin / phi.cos;
}

double DraftGearParams::SteepestLoading() const {
  const double factor = TanWedge() / (TanWedge() - static_friction_coefficient);
  return factor * std::max(GearSpringSlope(*this, 0.0), GearSpringSlope(*this, travel_m));
}

}  // namespace train_dynamics
