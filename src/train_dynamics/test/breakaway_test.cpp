// Resistance of bearings while vehicles start: the law, both models, a train; forces and distances by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "ride.h"
#include "simulate.h"
#include "strict_config/validate.h"
#include "train_dynamics/resistance/propulsion.h"
#include "train_dynamics/train/breakaway_loads.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

// An ore wagon: 160.1138 t on four axles.
constexpr double kMassKg = 160113.8;
const double kAxleT = 1e-3 * kMassKg / 4.0;
const double kRoller = 28.0 / (kAxleT + 7.0), kPlain = 142.0 / (kAxleT + 7.0);  // N/kN

TEST(Breakaway, LawsByHand) {
  // 22.5 t per axle: 28 / 29.5 and 142 / 29.5 N/kN of 882.9 kN.
  EXPECT_NEAR(BreakawayResistance({}, 90e3, 4), 882.9 * 28.0 / 29.5, 1e-9);
  EXPECT_NEAR(BreakawayResistance({BreakawayLaw::kPlainBearings}, 90e3, 4), 882.9 * 142.0 / 29.5, 1e-9);
  EXPECT_NEAR(BreakawayResistance({BreakawayLaw::kConstant, 5.0}, 90e3, 4), 882.9 * 5.0, 1e-9);
}

TEST(Breakaway, ConstantNeedsItsValue) {
  BreakawayParams p{BreakawayLaw::kConstant};
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
  p = {BreakawayLaw::kRollerBearings};
  EXPECT_NO_THROW(strict_config::Validate(p));
  p.distance_m = 0.0;
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
}

VehicleParams PlainBearings() {
  VehicleParams p = OreWagon();
  p.propulsion_resistance.breakaway = BreakawayParams{BreakawayLaw::kPlainBearings};
  return p;
}

TEST(BreakawayLoads, HoldFromStandstillForADistanceEitherWay) {
  TrainParams train;
  train.consist.resize(2);
  train.consist[0].vehicle = PlainBearings();
  train.consist[1].vehicle = OreWagon();
  const Consist consist(train);
  BreakawayLoads starting(consist);
  LoadArrays loads;
  const double held_n = 1e-3 * 9.81 * kMassKg * kPlain;
  const auto at = [&](double x, double v) {
    starting.Evaluate({x, 0.0}, {v, 0.0}, loads);
    if (loads.breakaway_resistance_n.empty()) return 0.0;
    EXPECT_EQ(loads.breakaway_resistance_n[1], 0.0);
    return loads.breakaway_resistance_n[0];
  };
  EXPECT_EQ(at(0.0, 5.0), 0.0);  // it has not stood
  EXPECT_EQ(at(20.0, 2.0), 0.0);
  EXPECT_NEAR(at(30.0, 0.0), held_n, 1e-3);
  EXPECT_NEAR(at(30.5, 0.3), held_n, 1e-3);
  EXPECT_NEAR(at(29.1, -0.3), held_n, 1e-3);
  EXPECT_EQ(at(31.0, 0.5), 0.0);
  EXPECT_EQ(at(35.0, 0.5), 0.0);
  EXPECT_NEAR(at(30.8, 1e-3), held_n, 1e-3);  // stood there, a new start
  EXPECT_EQ(at(29.7, -0.5), 0.0);
  EXPECT_TRUE(loads.breakaway_resistance_n.empty());  // nothing is sent
}

TEST(BreakawayLoads, AreEmptyInATrainWithout) {
  TrainParams train;
  train.consist.resize(1);
  train.consist[0].vehicle = OreWagon();
  BreakawayLoads starting{Consist(train)};
  LoadArrays loads;
  starting.Evaluate({0.0}, {0.0}, loads);
  EXPECT_TRUE(starting.empty());
  EXPECT_TRUE(loads.breakaway_resistance_n.empty());
}

/// One wagon released on a grade, for so long, of either model; breakaway as text, empty: none.
struct Started {
  double speed_kmh, rolling_j, gravity_j;
};
Started Start(const std::string& model, double grade_percent, const std::string& breakaway) {
  std::vector<std::string> set = {
      "model=" + model, "initial_speed_kmh=0", "commands=[]", "duration_s=60",
      "track={name: fall, grades: [{from_m: 0, grade_percent: " + std::to_string(grade_percent) + "}]}"};
  if (!breakaway.empty()) set.push_back("train.consist[0].vehicle.propulsion_resistance.breakaway=" + breakaway);
  const Outcome outcome = Simulate("single_wagon_stop", set);
  Started started{outcome.mean_speed_kmh, 0.0, outcome.ledger.gravity_work_j};
  for (const auto& [element, energy] : outcome.ledger.dissipated_j)
    if (element == "rolling_resistance") started.rolling_j = energy;
  return started;
}

// The paper's resistance at rest, 0.92 N/kN, holds a wagon on 0.09 % and lets it go on 0.1 %; bearings that resist more
// by 142 / (q0 + 7) = 3.0194 N/kN hold it up to 0.30194 %.
TEST(Breakaway, DecidesOnWhichGradeAWagonStarts) {
  EXPECT_NEAR(kPlain, 3.0194, 1e-4);
  for (const std::string model : {"ltd", "2d"}) {
    EXPECT_LT(std::abs(Start(model, -0.09, "").speed_kmh), 0.01) << model;
    EXPECT_GT(Start(model, -0.1, "").speed_kmh, 0.05) << model;
    EXPECT_LT(std::abs(Start(model, -0.298, "{law: plain_bearings}").speed_kmh), 0.01) << model;
    EXPECT_GT(Start(model, -0.306, "{law: plain_bearings}").speed_kmh, 0.05) << model;
    EXPECT_LT(std::abs(Start(model, -0.49, "{law: constant, constant_n_per_kn: 5}").speed_kmh), 0.01) << model;
  }
}

// Where it is less than the law's own a + b k (28 / 47.03 = 0.595 against 0.92 N/kN) nothing changes, to the bit.
TEST(Breakaway, WeakerThanTheLawChangesNothing) {
  EXPECT_LT(kRoller, 0.92);
  for (const std::string model : {"ltd", "2d"}) {
    const Started with = Start(model, -0.2, "{law: roller_bearings}"), without = Start(model, -0.2, "");
    EXPECT_EQ(with.speed_kmh, without.speed_kmh) << model;
    EXPECT_EQ(with.rolling_j, without.rolling_j) << model;
  }
}

// Constant forces: over the first metre W (g - w), then W (g - a - b k): the energy that the start takes beyond the
// law.
TEST(Breakaway, TakesItsWorkOverTheFirstMetre) {
  const double weight_n = 9.81 * kMassKg;
  for (const std::string model : {"ltd", "2d"}) {
    const Outcome outcome = Simulate("single_wagon_stop",
                                     {"model=" + model, "initial_speed_kmh=0", "commands=[]", "duration_s=90",
                                      "track={name: fall, grades: [{from_m: 0, grade_percent: -0.5}]}",
                                      "train.consist[0].vehicle.propulsion_resistance={law: abc, constant_n_per_kn: 1, "
                                      "linear_n_per_kn_kmh: 0, quadratic_n_per_kn_kmh2: 0, breakaway: {law: constant, "
                                      "constant_n_per_kn: 4, distance_m: 2}}"});
    double rolling_j = 0.0;
    for (const auto& [element, energy] : outcome.ledger.dissipated_j)
      if (element == "rolling_resistance") rolling_j = energy;
    const double way_m = outcome.ledger.gravity_work_j / (5e-3 * weight_n);
    EXPECT_GT(way_m, 100.0) << model;
    EXPECT_NEAR((rolling_j - 1e-3 * weight_n * way_m) / weight_n, 3e-3 * 2.0, 2e-5) << model;
    EXPECT_LT(outcome.largest_residual_j, 1e-6 * outcome.ledger.gravity_work_j) << model;
  }
}

}  // namespace
}  // namespace train_dynamics
