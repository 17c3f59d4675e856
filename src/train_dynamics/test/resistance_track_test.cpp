#include <gtest/gtest.h>

#include <cmath>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/numeric/trigonometry.h"
#include "train_dynamics/resistance/propulsion.h"
#include "train_dynamics/track/track.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

// ---- propulsion resistance
// ------------------------------------------------------------------------------------------

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
    EXPECT_NEAR(RollingResistance(c, 1e3, v) + AirDrag(c, 1e3, v), expected[i], 5e-5)
        << 40 * i;  // printed digits
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

// ---- track
// ----------------------------------------------------------------------------------------------------------

TEST(Grade, HoldsFromItsEntryToTheNext) {
  TrackParams track;
  EXPECT_EQ(GradeAt(track, 123.0), 0.0);
  track.grades = {{0.0, -0.5}, {100.0, 0.0}, {250.0, 1.5}};
  EXPECT_EQ(GradeAt(track, -1e6), -0.005);  // the first also holds before it
  EXPECT_EQ(GradeAt(track, 0.0), -0.005);
  EXPECT_EQ(GradeAt(track, 99.999), -0.005);
  EXPECT_EQ(GradeAt(track, 100.0), 0.0);
  EXPECT_EQ(GradeAt(track, 250.0), 0.015);
  EXPECT_EQ(GradeAt(track, 1e9), 0.015);
  EXPECT_EQ(GradeUnder<double>(track, 180.0), 0.0);
  track.grades = {{100.0, 2.0}};
  EXPECT_EQ(GradeUnder<double>(track, -5.0), 0.02);
}

TEST(Grade, EntriesMustAscend) {
  TrackParams track;
  track.grades = {{0.0, 1.0}, {0.0, 2.0}};
  EXPECT_THROW(strict_config::Validate(track), std::invalid_argument);
}

TEST(Dip, IsEq7) {
  const DipParams dip{40.0, 0.0512, 10.0};
  for (double x = 0.0; x <= 10.0; x += 0.1) {
    // Accuracy of the cosine, 2e-16, times the depth.
    EXPECT_NEAR(DipHeight(dip, 40.0 + x).height, -0.0256 * (1.0 - std::cos(2.0 * kPi * x / 10.0)), 1e-16);
  }
  EXPECT_NEAR(DipHeight(dip, 45.0).height, -0.0512, 1e-17);  // positive depth is down
}

TEST(Dip, SlopeIsTheDerivativeAndBothVanishOutside) {
  const DipParams dip{-3.0, 0.03, 7.0};
  constexpr double kStep = 1e-4;
  for (double x = -4.03; x < 5.0; x += 0.05) {
    const double difference =
        (DipHeight(dip, x + kStep).height - DipHeight(dip, x - kStep).height) / (2.0 * kStep);
    // h^2/6 times the third derivative, 0.011 1/m^2; across an end h/4 times the jump of the second, 0.012
    // 1/m.
    EXPECT_NEAR(DipHeight(dip, x).slope, difference, 3e-7) << x;
  }
  for (const double x : {-100.0, -3.0, 4.0, 100.0}) {
    EXPECT_EQ(DipHeight(dip, x).height, 0.0);
    EXPECT_EQ(DipHeight(dip, x).slope, 0.0);
  }
}

TEST(Dip, OverlappingDipsAddUp) {
  TrackParams track;
  track.dips = {{0.0, 0.05, 10.0}, {4.0, -0.02, 8.0}};
  for (const double x : {2.0, 5.0, 9.0, 11.0}) {
    const RailHeight<double> one = DipHeight(track.dips[0], x), other = DipHeight(track.dips[1], x);
    EXPECT_EQ(RailHeightAt(track, x).height, one.height + other.height);
    EXPECT_EQ(RailHeightUnder<double>(track, x).slope, one.slope + other.slope);
  }
}

TEST(FrictionPatch, ReplacesTheVehiclesOwn) {
  AdhesionParams own;
  own.friction_coefficient = 0.4;
  const auto friction_at = [&own](const Track& track, double x) {
    return track.SurfaceAt(x, own).friction_coefficient;
  };
  TrackParams track;
  EXPECT_EQ(friction_at(track, 5.0), 0.4);
  track.friction_patches = {{0.0, 100.0, 0.05}, {50.0, 60.0, 0.3}};
  EXPECT_EQ(friction_at(track, -0.001), 0.4);
  EXPECT_EQ(friction_at(track, 0.0), 0.05);
  EXPECT_EQ(friction_at(track, 55.0), 0.3);  // the later entry holds
  EXPECT_EQ(friction_at(track, 60.0), 0.05);
  EXPECT_EQ(friction_at(track, 100.0), 0.4);
  EXPECT_EQ(RailSurfaceUnder<double>(track, 55.0, own).friction, 0.3);
}

// ---- trigonometry
// ---------------------------------------------------------------------------------------------------

TEST(Trigonometry, AgreesWithTheLibrary) {
  for (double turns = -3.0; turns < 3.0; turns += 0.000731) {
    const SinCos sc = SinCosTurns(turns);
    const long double angle = 2.0L * std::acos(-1.0L) * turns;
    // The documented 2e-16, and half an ulp of 2 pi for the angle itself.
    EXPECT_NEAR(sc.sin, static_cast<double>(std::sin(angle)), 3e-16);
    EXPECT_NEAR(sc.cos, static_cast<double>(std::cos(angle)), 3e-16);
  }
  EXPECT_NEAR(SinCosDegrees(22.0).sin, std::sin(22.0 * kPi / 180.0), 3e-16);
}

TEST(Trigonometry, IsExactAtQuarterTurns) {
  for (int turn = -2; turn <= 2; ++turn) {
    EXPECT_EQ(SinCosTurns(turn).sin, 0.0);
    EXPECT_EQ(SinCosTurns(turn).cos, 1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.25).sin, 1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.25).cos, 0.0);
    EXPECT_EQ(SinCosTurns(turn + 0.5).cos, -1.0);
    EXPECT_EQ(SinCosTurns(turn + 0.75).sin, -1.0);
  }
}

}  // namespace
}  // namespace train_dynamics
