#include "train_dynamics/brake/shoe_friction.h"

#include <gtest/gtest.h>

#include "paper_vehicle.h"
#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

TEST(ShoeFriction, LimitsAndAValueByHand) {
  const ShoeFrictionParams& p = OreWagon().brake_rigging.shoe_friction;
  EXPECT_EQ(ShoeFriction(p, 0.0), 0.322);
  EXPECT_NEAR(ShoeFriction(p, 1e12), 0.161, 1e-10);
  EXPECT_NEAR(ShoeFriction(p, 80.0 / 3.6), 0.322 * 230.0 / 310.0, 1e-15);  // rounding
  EXPECT_EQ(ShoeFriction(p, -20.0), ShoeFriction(p, 20.0));
}

TEST(ShoeForce, IsLoadTimesFriction) {
  const BrakeRigging p = OreWagon().Rigging();
  EXPECT_NEAR(ShoeForce(p, 430e3, 0.0), 0.46035 * 430e3 * 0.322, 1e-9);
  EXPECT_EQ(ShoeForce(p, 0.0, 10.0), 0.0);
}

}  // namespace
}  // namespace train_dynamics
