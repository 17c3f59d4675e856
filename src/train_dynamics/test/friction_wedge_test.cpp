#include "train_dynamics/suspension/friction_wedge.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "energy_slope.h"
#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

double Radians(double degrees) { return degrees * std::acos(-1.0) / 180.0; }

TEST(WedgeSpring, ForceIsTheSlopeOfTheEnergyInTwoStages) {
  const FrictionWedgeParams p = *OreWagon().friction_wedge;
  const auto energy = [&p](double travel) { return WedgeSpringEnergy(p, travel); };
  for (double travel = -0.0101; travel < 0.08; travel += 0.0007) {
    EXPECT_NEAR(Slope(energy, travel), WedgeSpringForce(p, travel), 1e-4) << travel;
  }
  EXPECT_EQ(WedgeSpringForce(p, -0.01), 0.0);  // the wedge stands loose, it does not pull
  EXPECT_NEAR(WedgeSpringForce(p, 0.020), 983e3 * 0.020, 1e-9);
  EXPECT_NEAR(WedgeSpringForce(p, 0.050), 983e3 * 0.050 + 566e3 * 0.028, 1e-9);
}

// Eq 6 of the paper, corrected, as it stands: columns FN1, FN2 and the bolster's acceleration. With a
// massless wedge, returns the vertical force on the bolster per unit of wedge spring force; `direction` is
// sgn(z_bolster' - z_frame').
double ForceRatioOfEq6(const FrictionWedgeParams& p, double mu, double direction) {
  const double a = Radians(p.wedge_angle_deg), g = Radians(p.toe_angle_deg), sg = direction;
  constexpr double kWedgeMass = 0.0, kBolsterShare = 280.0, kSpringForce = 1.0, kOtherForces = 0.0;
  Eigen::Matrix3d m;
  m << std::cos(g) - mu * sg * std::sin(g), -std::cos(a) - mu * sg * std::sin(a),
      -kWedgeMass * std::sin(a) * std::sin(g) / std::sin(a + g),  //
      -std::sin(g) - mu * sg * std::cos(g), -std::sin(a) + mu * sg * std::cos(a),
      -kWedgeMass * std::sin(a) * std::cos(g) / std::sin(a + g),  //
      0.0, std::sin(a) - mu * sg * std::cos(a), -kBolsterShare;
  const Eigen::Vector3d solution = m.partialPivLu().solve(Eigen::Vector3d(0.0, -kSpringForce, kOtherForces));
  EXPECT_GT(solution[0], 0.0);  // both faces are pressed
  EXPECT_GT(solution[1], 0.0);
  return kBolsterShare * solution[2] / kSpringForce;
}

TEST(FrictionWedge, ForceRatioSolvesEq6) {
  FrictionWedgeParams p = *OreWagon().friction_wedge;
  for (const double toe : {2.5, 0.0, -1.0, 5.0}) {
    for (const double slope : {30.0, 40.0, 55.0}) {
      p.toe_angle_deg = toe;
      p.wedge_angle_deg = slope;
      const FrictionWedge wedge(p);
      for (const double mu : {0.0, 0.05, 0.2, 0.35}) {
        // Rounding of a well-conditioned 3 x 3 solution.
        EXPECT_NEAR(wedge.ForceRatio(mu), ForceRatioOfEq6(p, mu, -1.0),
                    1e-14);                                                       // bolster comes down: loading
        EXPECT_NEAR(wedge.ForceRatio(-mu), ForceRatioOfEq6(p, mu, +1.0), 1e-14);  // rises: unloading
      }
    }
  }
}

TEST(FrictionWedge, NumbersOfThePapersWedge) {
  const FrictionWedge wedge(*OreWagon().friction_wedge);
  // Half a unit of the last digit of the project's notes.
  EXPECT_NEAR(wedge.ForceRatio(0.2), 1.14, 0.005);
  EXPECT_NEAR(wedge.ForceRatio(0.0), 0.95, 0.005);
  EXPECT_NEAR(wedge.ForceRatio(-0.2), 0.69, 0.005);
  EXPECT_NEAR(wedge.kappa, 0.9505, 0.00005);
}

TEST(FrictionWedge, KappaIsTheTravelOfTheWedge) {
  // The bolster comes down by 1 and the wedge slides down the column by s, at gamma to the vertical, and
  // along the bolster's slope by t, at alpha to the vertical: s (sin g, -cos g) - t (sin a, cos a) = (0, -1).
  FrictionWedgeParams p = *OreWagon().friction_wedge;
  for (const double toe : {-3.0, 0.0, 2.5}) {
    p.toe_angle_deg = toe;
    const double a = Radians(p.wedge_angle_deg), g = Radians(toe);
    Eigen::Matrix2d m;
    m << std::sin(g), -std::sin(a), -std::cos(g), -std::cos(a);
    const Eigen::Vector2d slide = m.partialPivLu().solve(Eigen::Vector2d(0.0, -1.0));
    EXPECT_NEAR(FrictionWedge(p).kappa, slide[0] * std::cos(g), 1e-15);  // rounding
  }
}

TEST(FrictionWedge, BoundsOpposeTheMotionAndScaleWithTheSpring) {
  const FrictionWedge wedge(*OreWagon().friction_wedge);
  for (const double rate : {0.0, 0.003, 0.5}) {
    const WedgeFrictionBounds<double> bounds = WedgeFriction(wedge, 5e4, rate);
    EXPECT_LT(bounds.lower, 0.0);
    EXPECT_GT(bounds.upper, 0.0);
    EXPECT_NEAR(WedgeFriction(wedge, 1e5, rate).upper, 2.0 * bounds.upper, 1e-10);
    EXPECT_EQ(WedgeFriction(wedge, 5e4, -rate).upper, bounds.upper);  // even in the rate
    // Elastic part and friction together are Eq 6 again.
    const double mu = 0.20 + 0.03 / (1.0 + std::pow(rate / 0.01, 2));
    EXPECT_NEAR(wedge.kappa * 5e4 + bounds.upper, 5e4 * ForceRatioOfEq6(wedge.params, mu, -1.0), 1e-9);
    EXPECT_NEAR(wedge.kappa * 5e4 + bounds.lower, 5e4 * ForceRatioOfEq6(wedge.params, mu, +1.0), 1e-9);
  }
  EXPECT_EQ(WedgeFriction(wedge, 0.0, 0.0).upper, 0.0);
  EXPECT_EQ(WedgeFriction(wedge, 0.0, 0.0).lower, 0.0);
}

TEST(FrictionWedge, FrictionFallsFromStaticToKinetic) {
  const FrictionWedge wedge(*OreWagon().friction_wedge);
  const auto upper = [&wedge](double mu) { return 1e5 * (wedge.ForceRatio(mu) - wedge.kappa); };
  EXPECT_EQ(WedgeFriction(wedge, 1e5, 0.0).upper, upper(0.23));
  EXPECT_NEAR(WedgeFriction(wedge, 1e5, 0.01).upper, upper(0.215), 1e-9);  // half way at the blend speed
  EXPECT_NEAR(WedgeFriction(wedge, 1e5, 10.0).upper, upper(0.20), 0.1);    // 1e-6 of the drop is left
  double last = 1e9;
  for (double rate = 0.0; rate < 0.1; rate += 1e-3) {
    const double now = WedgeFriction(wedge, 1e5, rate).upper;
    EXPECT_LT(now, last);
    last = now;
  }
}

}  // namespace
}  // namespace train_dynamics
