#include "train_dynamics/traction/tractive_effort.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "locomotive_ride.h"
#include "strict_config/validate.h"
#include "train_dynamics/traction/locomotive.h"

namespace train_dynamics {
namespace {

TEST(NotchShare, IsThatOfWholeNotchesAndLinearBetweenThem) {
  const std::vector<double> shares = {0.1, 0.4, 1.0};
  EXPECT_EQ(NotchShare(shares, 0.0), 0.0);
  EXPECT_EQ(NotchShare(shares, -1.0), 0.0);
  EXPECT_NEAR(NotchShare(shares, 0.5), 0.05, 1e-15);
  EXPECT_EQ(NotchShare(shares, 1.0), 0.1);
  EXPECT_EQ(NotchShare(shares, 2.0), 0.4);
  EXPECT_NEAR(NotchShare(shares, 2.25), 0.55, 1e-15);
  EXPECT_EQ(NotchShare(shares, 3.0), 1.0);
  EXPECT_EQ(NotchShare(shares, 9.0), 1.0);
}

TEST(TractiveEffort, IsTheSmallestOfItsLimits) {
  TractiveEffortParams p;
  p.starting_effort_n = 800e3;
  p.rim_power_w = 3.0e6;
  p.usable_adhesion.law = UsableAdhesionLaw::kConstant;
  p.usable_adhesion.coefficient = 0.36;
  EXPECT_EQ(TractiveEffort(p, 8, 0.0, 1e9), 800e3);
  EXPECT_EQ(TractiveEffort(p, 4, 0.0, 1e9), 400e3);
  EXPECT_NEAR(TractiveEffort(p, 8, 10.0, 1e9), 300e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 8, -10.0, 1e9), 300e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 5, 10.0, 1e9), 0.4923 * 300e3, 1e-9);  // a C44-9W's notch 5
  EXPECT_NEAR(TractiveEffort(p, 8, 0.0, 1e6), 360e3, 1e-9);            // adhesion
  p.table = EffortTableParams{{0.0, 36.0, 72.0}, {500e3, 250e3, 100e3}};
  EXPECT_EQ(TractiveEffort(p, 8, 0.0, 1e9), 500e3);
  EXPECT_NEAR(TractiveEffort(p, 8, 5.0, 1e9), 375e3, 1e-9);
  EXPECT_NEAR(TractiveEffort(p, 8, 40.0, 1e9), 50e3, 1e-9);  // beyond the table, constant power
  EXPECT_EQ(TractiveEffort(p, 0, 5.0, 1e9), 0.0);
}

TEST(TractiveEffort, LargestPowerOfATableLiesOnItsPointsOrBetween) {
  // Between 0 and 20 m/s, v (300 - 10 v) is largest at 15 m/s: 2250 kW.
  EXPECT_NEAR((EffortTableParams{{0.0, 72.0}, {300e3, 100e3}}.LargestPower()), 2.25e6, 1e-6);
  EXPECT_NEAR((EffortTableParams{{0.0, 36.0}, {300e3, 290e3}}.LargestPower()), 2.9e6, 1e-6);
  EXPECT_NEAR((EffortTableParams{{10.0, 36.0}, {300e3, 300e3}}.LargestPower()), 3.0e6, 1e-6);
}

TEST(TractionParams, BadTablesAreRefused) {
  TractionParams p = QuickLocomotive(1e5, 1e6);
  EXPECT_NO_THROW(strict_config::Validate(p));
  const auto expect_refused = [&p](const std::function<void(TractionParams&)>& spoil, const std::string& words) {
    TractionParams bad = p;
    spoil(bad);
    try {
      strict_config::Validate(bad);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  expect_refused([](TractionParams& b) { b.tractive_effort.throttle.effort_share[3] = 0.1; },
                 "tractive_effort.throttle.effort_share must ascend from notch to notch");
  expect_refused([](TractionParams& b) { b.tractive_effort.throttle.power_share.pop_back(); },
                 "must have as many values as effort_share");
  expect_refused([](TractionParams& b) { b.tractive_effort.table = EffortTableParams{}; },
                 "tractive_effort.table.speed_kmh must list the speeds of the table");
  expect_refused([](TractionParams& b) { b.tractive_effort.rim_power_w = 0.0; },
                 "tractive_effort.rim_power_w must be > 0, got 0");
  expect_refused(
      [](TractionParams& b) {
        b.tractive_effort.table = EffortTableParams{{0, 10}, {1e5, 2e5}};
      },
      "tractive_effort.table.effort_n must not ascend");
  expect_refused([](TractionParams& b) { b.driven_wheelsets = {2, 1}; }, "driven_wheelsets must ascend");
}

// Effort of a C44AC in notch 8 off its own meter, at six speeds (A. Krug, Railroad Facts): a constant power of
// 3.03 MW at the rims stands for it within 3 %.
TEST(TractiveEffort, C44acAtSixSpeeds) {
  const std::vector<double> mph = {15, 20, 25, 30, 35, 40}, effort_lbf = {100000, 77000, 61000, 51000, 44000, 38000};
  TractiveEffortParams p = QuickLocomotive(800e3, 3.03e6).tractive_effort;
  for (std::size_t i = 0; i < mph.size(); ++i) {
    const double measured_n = 4.44822 * effort_lbf[i];
    EXPECT_NEAR(TractiveEffort(p, 8, 0.44704 * mph[i], 1.85e6), measured_n, 0.03 * measured_n) << mph[i];
  }
}

}  // namespace
}  // namespace train_dynamics
