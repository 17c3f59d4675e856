// Resistance of curves: the laws, and the work that they take from vehicles of both models.
#include "train_dynamics/resistance/curving.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "ride.h"
#include "simulate.h"
#include "strict_config/validate.h"
#include "train_dynamics/train/curving_loads.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

CurvingResistanceParams By(CurvingResistanceLaw law) { return {law, {}}; }

TEST(CurvingResistance, ValuesOfAnIndependentProgram) {
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kCole), 1.0 / 400.0), 15.290, 5e-4);
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kArea), -1.0 / 400.0), 17.126, 5e-4);
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kRoeckl), 1.0 / 400.0), 18.48, 5e-3);
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kRoeckl), 1.0 / 400.0) / 9.81, 1.8841,
              5e-5);  // permille
  for (const CurvingResistanceLaw law :
       {CurvingResistanceLaw::kCole, CurvingResistanceLaw::kArea, CurvingResistanceLaw::kRoeckl}) {
    EXPECT_EQ(CurvingResistance(By(law), 0.0), 0.0);
  }
}

TEST(CurvingResistance, AreaIsEightTenthsOfAPoundPerTonAndDegree) {
  // A curve of one degree: 100 ft of chord subtend it.
  const double radius_m = 50.0 * 0.3048 / std::sin(kPi / 360.0);
  EXPECT_NEAR(radius_m, 1746.40, 5e-3);
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kArea), 1.0 / radius_m), 0.8 * 4.44822 / 0.90718474, 1e-3);
}

TEST(CurvingResistance, RoecklIsNotContinuousAt300m) {
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kRoeckl), 1.0 / 300.0) / 9.81, 2.6531, 1e-4);
  EXPECT_NEAR(CurvingResistance(By(CurvingResistanceLaw::kRoeckl), 1.0 / 299.9999) / 9.81, 1.8519, 1e-4);
}

TEST(CurvingResistance, TableIsLinearAndFallsWithTheRadiusBeyondItsEnd) {
  CurvingResistanceParams p = By(CurvingResistanceLaw::kTable);
  p.table = {{200.0, 400.0}, {30.0, 10.0}};
  EXPECT_NO_THROW(strict_config::Validate(p));
  EXPECT_EQ(CurvingResistance(p, 1.0 / 100.0), 30.0);
  EXPECT_NEAR(CurvingResistance(p, -1.0 / 300.0), 20.0, 1e-12);
  EXPECT_NEAR(CurvingResistance(p, 1.0 / 800.0), 5.0, 1e-12);
  p.table = {{200.0, 400.0}, {10.0, 30.0}};
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
}

// With `cole` the work through a curve depends on its angle only: 6116 theta.
TEST(CurvingResistance, WorkOfARightAngle) {
  const double radius_m = 500.0;
  const double work = CurvingResistance(By(CurvingResistanceLaw::kCole), 1.0 / radius_m) * radius_m * 0.5 * kPi;
  EXPECT_NEAR(work, 9606.99, 5e-3);  // J/t
}

VehicleParams WithoutOtherResistance() {
  VehicleParams p = OreWagon();
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  return p;
}

struct Passage {
  double speed_mps, work_j;  ///< behind the curve; taken by it
};

/// One LTD ore wagon at 20 m/s through a curve of 400 m radius.
Passage Pass(double length_m, bool with_inertia, double dt) {
  TrainParams train;
  train.consist.resize(1);
  train.consist[0].vehicle = WithoutOtherResistance();
  const Consist consist(train);
  TrackParams track;
  track.curves = {{30.0, 30.0 + length_m, 400.0}};
  const CurvingLoads curves(track, consist, 0.0);
  const LtdVehicle vehicle(consist.vehicle(0), with_inertia);
  LtdState<double> s;
  s.v_mps = 20.0;
  while (s.x_m < 40.0 + length_m) {
    LoadArrays arrays;
    curves.Evaluate(dt, {s.x_m}, {s.v_mps}, arrays);
    VehicleLoads<double> loads;
    loads.curving_resistance_n = arrays.curving_resistance_n[0];
    StepLtd(vehicle, {}, loads, dt, s);
  }
  return {s.v_mps, s.work.dissipated[kCurvingResistance]};
}

TEST(CurvingLoads, SlowAnOreWagonAsAnIndependentProgramSays) {
  EXPECT_NEAR(Pass(1000.0, false, 1e-3).speed_mps, 19.22030, 5e-6);
  EXPECT_NEAR(Pass(1000.0, true, 1e-3).speed_mps, 19.27374, 5e-6);
}

TEST(CurvingLoads, KeepTheWorkOfCurvesShorterThanTheVehicle) {
  const double mass_t = 1e-3 * OreWagon().TotalMass();
  for (const double length_m : {0.05, 0.3, 1.0, 7.0}) {
    for (const double dt : {1e-3, 5e-3}) {
      const double work = 6116.0 / 400.0 * mass_t * length_m;
      EXPECT_NEAR(Pass(length_m, true, dt).work_j, work, 1e-3 * work) << length_m << " m, " << dt << " s";
    }
  }
}

TEST(CurvingLoads, OnStraightTrackAreNotSent) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("emergency"), {"model=ltd"});
  const CurvingLoads curves(loaded.params.track, loaded.consist, 0.0);
  LoadArrays loads;
  curves.Evaluate(1e-3, std::vector<double>(242, 0.0), std::vector<double>(242, 20.0), loads);
  EXPECT_TRUE(curves.empty());
  EXPECT_TRUE(loads.curving_resistance_n.empty());
}

// A force on the wheelsets' centres: it slows mass and rotation, and takes no adhesion of its own.
TEST(CurvingInTwoDimensions, SlowsTheWagonWithoutTorque) {
  const VehicleParams p = WithoutOtherResistance();
  Ride ride(p, TrackParams(), 20.0);
  ride.loads.curving_resistance_n = 15.29 * 160.1138;
  ride.Run(5.0);
  const double v0 = ride.Speed(), before = ride.Distance();
  ride.Run(10.0);
  const double inertia_kg = p.TotalMass() + EquivalentRotationalMass(p);
  EXPECT_NEAR(ride.Speed() - v0, -10.0 * ride.loads.curving_resistance_n / inertia_kg, 1e-5);
  EXPECT_GT(ride.Distance(), before);
  // The rail only slows the rotation: J a / r^2, of each wheelset, turned forwards by the train.
  const double a = -ride.loads.curving_resistance_n / inertia_kg;
  for (const double creep_n : ride.output.creep_force_n) EXPECT_NEAR(creep_n, 679.0 / (0.485 * 0.485) * a, 2.0);
  EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
}

TEST(CurvingInTwoDimensions, HoldsAStandingWagon) {
  TrackParams fall;
  fall.grades = {{0.0, -0.1}};
  Ride ride(WithoutOtherResistance(), fall, 0.0);
  ride.loads.curving_resistance_n = 3000.0;  // 1571 N pull
  ride.Run(20.0);
  const double x = ride.Distance();
  ride.Run(20.0);
  EXPECT_NEAR(ride.Distance(), x, 1e-5);
  EXPECT_LT(std::abs(ride.Distance()), 0.01);
  ride.loads.curving_resistance_n = 1000.0;
  ride.Run(20.0);
  EXPECT_GT(ride.Distance(), 0.5);
}

// A train whose vehicles are in the curve or not, in both models; its books.
TEST(CurvingLoads, TakeTheWorkOfEveryVehicleInATrain) {
  for (const char* model : {"ltd", "2d"}) {
    const Outcome outcome = Simulate(
        "emergency", {std::string("model=") + model, "commands=[]", "duration_s=20", "detail_vehicles=[]",
                      "train.consist[1].count=2", "train.consist[2].count=1", "train.consist[3].count=2",
                      "brake=single_vehicle", "initial_speed_kmh=36",
                      "track={name: curve, curves: [{from_m: 20, to_m: 50, radius_m: 300}, {from_m: 60, to_m: 65, "
                      "radius_m: -200}]}"});
    double work_j = 0.0;
    for (const auto& [element, energy] : outcome.ledger.dissipated_j) {
      if (element == "curving_resistance") work_j = energy;
    }
    const double expected_j = 6116.0 * (30.0 / 300.0 + 5.0 / 200.0) * 6.0 * 160.1138;
    EXPECT_NEAR(work_j, expected_j, 1e-3 * expected_j) << model;  // all six vehicles have passed both curves
    ExpectLedgerCloses(outcome, model);
  }
}

}  // namespace
}  // namespace train_dynamics
