#include "train_dynamics/suspension/spring_nest.h"

#include <gtest/gtest.h>

#include "energy_slope.h"
#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

TEST(SpringNest, ForceIsTheSlopeOfTheEnergy) {
  const SpringNestParams& p = OreWagon().spring_nest;
  const auto energy = [&p](double d) { return SpringNestEnergy(p, d); };
  for (double d = -0.0201; d < 0.09; d += 0.0007) {
    EXPECT_NEAR(Slope(energy, d), SpringNestForce(p, d), 1e-4) << d;
  }
}

TEST(SpringNest, StagesAndStops) {
  const SpringNestParams& p = OreWagon().spring_nest;
  const auto stiffness = [&p](double d) {
    return (SpringNestForce(p, d + 1e-4) - SpringNestForce(p, d - 1e-4)) / 2e-4;
  };
  const double outer = 1590e3, inner = 566e3, solid = 4e8;  // the paper's
  // A difference of a straight line: rounding, 1e-16 x 1e6 N / 1e-4 m.
  EXPECT_NEAR(stiffness(0.010), outer, 1e-3);
  EXPECT_NEAR(stiffness(0.050), outer + inner, 1e-3);
  EXPECT_NEAR(stiffness(0.080), outer + inner + solid, 1e-2);
  EXPECT_EQ(stiffness(-0.004), 0.0);
  EXPECT_NEAR(stiffness(-0.012), solid, 1e-3);
  EXPECT_EQ(SpringNestForce(p, 0.0), 0.0);
  EXPECT_NEAR(SpringNestForce(p, 0.022), outer * 0.022, 1e-9);
  EXPECT_NEAR(SpringNestForce(p, 0.074), outer * 0.074 + inner * 0.052, 1e-9);
  EXPECT_LT(SpringNestForce(p, -0.009), 0.0);  // the rebound stop pulls
}

TEST(SpringNest, IsContinuous) {
  const SpringNestParams& p = OreWagon().spring_nest;
  // The steepest piece has 4.02e8 N/m: 1e-9 m may change the force by 0.4 N.
  for (const double kink : {-0.008, 0.0, 0.022, 0.074}) {
    EXPECT_NEAR(SpringNestForce(p, kink - 5e-10), SpringNestForce(p, kink + 5e-10), 0.41) << kink;
  }
}

}  // namespace
}  // namespace train_dynamics
