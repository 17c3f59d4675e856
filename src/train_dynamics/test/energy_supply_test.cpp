#include "train_dynamics/traction/energy_supply.h"

#include <gtest/gtest.h>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

TEST(EnergySupply, TakesPowerOverEfficiency) {
  EnergySupplyParams p;
  p.power_share = {0.1, 0.5, 1.0};
  p.efficiency = {0.2, 0.36, 0.4};
  p.idle_power_w = 20e3;
  EXPECT_EQ(PowerTaken(p, 0.0, 2e6), 20e3);
  EXPECT_NEAR(PowerTaken(p, 1e6, 2e6), 20e3 + 1e6 / 0.36, 1e-6);
  EXPECT_NEAR(PowerTaken(p, 1.5e6, 2e6), 20e3 + 1.5e6 / 0.38, 1e-6);
  EXPECT_EQ(PowerTaken(p, -1e6, 2e6), 20e3);
  p.recovered_share = 0.6;
  EXPECT_NEAR(PowerTaken(p, -1e6, 2e6), 20e3 - 0.6e6, 1e-9);
}

}  // namespace
}  // namespace train_dynamics
