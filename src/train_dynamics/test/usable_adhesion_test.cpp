#include "train_dynamics/traction/usable_adhesion.h"

#include <gtest/gtest.h>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

TEST(UsableAdhesion, CurtiusKnifflerByHand) {
  // 0.161 + 7.5 / (k + 44); half a unit of the last printed digit
  EXPECT_NEAR(CurtiusKniffler(0.0), 0.33145, 5e-6);
  EXPECT_NEAR(CurtiusKniffler(40.0 / 3.6), 0.25029, 5e-6);
  EXPECT_NEAR(CurtiusKniffler(-80.0 / 3.6), 0.22148, 5e-6);
  UsableAdhesionParams p;
  p.factor = 1.2;
  EXPECT_NEAR(UsableAdhesion(p, 0.0), 1.2 * 0.3314545, 1e-6);
  p.law = UsableAdhesionLaw::kConstant;
  EXPECT_NEAR(UsableAdhesion(p, 30.0), 1.2 * 0.36, 1e-15);
}

}  // namespace
}  // namespace train_dynamics
