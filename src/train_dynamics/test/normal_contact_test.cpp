#include "train_dynamics/contact/normal_contact.h"

#include <gtest/gtest.h>

namespace train_dynamics {
namespace {

TEST(NormalContact, PushesOnlyAndOnlyWhileClosed) {
  EXPECT_EQ(OneSidedForce(6e8, 1e4, 1e-3, 0.0), 6e5);
  EXPECT_EQ(OneSidedForce(6e8, 1e4, -1e-3, 5.0), 0.0);  // open: an approaching body is not felt yet
  EXPECT_EQ(OneSidedForce(6e8, 1e4, 1e-6, -1.0), 0.0);  // separating: the damper may not pull
  EXPECT_EQ(OneSidedEnergy(6e8, -1e-3), 0.0);
}

TEST(NormalContact, ElasticForceIsTheSlopeOfTheEnergy) {
  // A central difference of a parabola is exact; what is left is rounding, 1e-16 x energy / step.
  for (const double d : {-1e-3, 1e-5, 3.3e-4, 2e-3}) {
    const double h = 1e-6;
    const double slope = (OneSidedEnergy(6e8, d + h) - OneSidedEnergy(6e8, d - h)) / (2.0 * h);
    EXPECT_NEAR(slope, OneSidedForce(6e8, 0.0, d, 0.0), 1e-6 * 6e5);
  }
}

}  // namespace
}  // namespace train_dynamics
