#include "train_dynamics/resistance/propulsion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paper_vehicle.h"
#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

TEST(PropulsionResistance, Eq5ByHand) {
  const ResistanceCoefficients p = OreWagon().Resistance();
  // 0.92 + 0.0048 80 + 0.000125 80^2 = 2.104 N per kN; a 40 t axle load is 1569.6 kN of weight.
  const double weight_n = 160e3 * 9.81, speed_mps = 80.0 / 3.6;
  EXPECT_NEAR(RollingResistance(p, weight_n, speed_mps) + AirDrag(p, weight_n, speed_mps), 2.104 * 1569.6,
              1e-9);  // rounding
  EXPECT_NEAR(RollingResistance(p, weight_n, 0.0) + AirDrag(p, weight_n, 0.0), 0.92 * 1569.6, 1e-9);
}

TEST(PropulsionResistance, SplitsIntoWheelsAndAir) {
  const ResistanceCoefficients p = OreWagon().Resistance();
  for (const double v : {0.0, 3.0, 22.2}) {
    EXPECT_NEAR(RollingResistance(p, 1e6, v), 1e3 * (0.92 + 0.0048 * 3.6 * v), 1e-9);
    EXPECT_NEAR(AirDrag(p, 1e6, v), 1e3 * 0.000125 * std::pow(3.6 * v, 2), 1e-9);
    EXPECT_EQ(RollingResistance(p, 1e6, -v), RollingResistance(p, 1e6, v));
    EXPECT_EQ(AirDrag(p, 1e6, -v), AirDrag(p, 1e6, v));
  }
  EXPECT_EQ(AirDrag(p, 1e6, 0.0), 0.0);
}

// Newtons per kilonewton of a four-axle wagon at 0, 40 and 80 km/h.
void ExpectResistance(const PropulsionResistanceParams& p, double mass_kg, double standing, double at_40,
                      double at_80) {
  const ResistanceCoefficients c = CoefficientsOf(p, mass_kg, 4);
  const double expected[] = {standing, at_40, at_80};
  for (int i = 0; i < 3; ++i) {
    const double v = 40.0 / 3.6 * i;
    EXPECT_NEAR(RollingResistance(c, 1e3, v) + AirDrag(c, 1e3, v), expected[i], 5e-5) << 40 * i;  // printed digits
  }
}

TEST(PropulsionResistance, LawsOfAnIndependentProgram) {
  PropulsionResistanceParams p;
  p.law = PropulsionResistanceLaw::kCn;
  p.cn = {105.0, 4.2};
  ExpectResistance(p, 128e3, 1.0048, 1.4740, 2.1362);
  p.cn = {105.0, 12.0};
  ExpectResistance(p, 28.5e3, 1.8953, 3.5064, 7.5943);
  p.law = PropulsionResistanceLaw::kModifiedDavis;
  ExpectResistance(p, 128e3, 0.4965, 0.7328, 1.2296);
  p.law = PropulsionResistanceLaw::kSzd;
  ExpectResistance(p, 128e3, 0.7937, 1.0437, 1.5437);
  ExpectResistance(OreWagon().propulsion_resistance, 128e3, 0.92, 1.312, 2.104);
}

TEST(PropulsionResistance, LawsByHand) {
  PropulsionResistanceParams p;
  p.law = PropulsionResistanceLaw::kSzd;  // 5 t per axle: the law of empty wagons
  ExpectResistance(p, 20e3, 1.0, 1.0 + 0.044 * 40 + 0.00024 * 1600, 1.0 + 0.044 * 80 + 0.00024 * 6400);
  p.law = PropulsionResistanceLaw::kStrahl;
  p.strahl = {2.2, 10.0, 15.0};  // a V 90
  ExpectResistance(p, 80e3, 2.2 + 10 * 0.15 * 0.15, 2.2 + 10 * 0.55 * 0.55, 2.2 + 10 * 0.95 * 0.95);
}

}  // namespace
}  // namespace train_dynamics
