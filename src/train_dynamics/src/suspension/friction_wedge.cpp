#include "train_dynamics/suspension/friction_wedge.h"

#include "train_dynamics/numeric/trigonometry.h"

namespace train_dynamics {

FrictionWedge::FrictionWedge(const FrictionWedgeParams& wedge) : params(wedge) {
  const SinCos alpha = SinCosDegrees(params.wedge_angle_deg);
  const SinCos gamma = SinCosDegrees(params.toe_angle_deg);
  sin_wedge = alpha.sin;
  cos_wedge = alpha.cos;
  sin_toe = gamma.sin;
  cos_toe = gamma.cos;
  inv_sin_sum = 1.0 / SinCosDegrees(params.wedge_angle_deg + params.toe_angle_deg).sin;
  kappa = ForceRatio(0.0);
}

}  // namespace train_dynamics
