#include "train_dynamics/suspension/centre_plate.h"

#include <gtest/gtest.h>

#include "energy_slope.h"
#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

TEST(CentrePlate, TwoRimsMakeThePlateAndNeverPull) {
  const CentrePlateParams& p = OreWagon().centre_plate;
  EXPECT_NEAR(2.0 * RimForce(p, 1e-3, 0.0), 4e8 * 1e-3, 1e-9);
  EXPECT_NEAR(2.0 * (RimForce(p, 1e-3, 0.1) - RimForce(p, 1e-3, 0.0)), 1e4 * 0.1, 1e-9);
  EXPECT_EQ(RimForce(p, -1e-6, 0.0), 0.0);
  EXPECT_EQ(RimForce(p, 1e-6, -10.0), 0.0);
  const auto energy = [&p](double d) { return RimEnergy(p, d); };
  for (const double d : {-1e-3, 2e-4, 1e-3}) EXPECT_NEAR(Slope(energy, d), RimForce(p, d, 0.0), 1e-4);
}

}  // namespace
}  // namespace train_dynamics
