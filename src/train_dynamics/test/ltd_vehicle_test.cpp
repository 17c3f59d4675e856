#include "train_dynamics/vehicle/ltd_vehicle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

constexpr LtdIntegrator kBoth[] = {LtdIntegrator::kNewmark};
constexpr double kEquivalentMass = 11546.4;  // [kg], Eq 8 for four wheelsets, to the paper's digit

// The paper's wagon without resistance and with a shoe friction of 0.322 at all speeds.
VehicleParams PlainVehicle() {
  VehicleParams p = OreWagon();
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  p.brake_rigging.shoe_friction.reference_speed_kmh = 1e15;
  return p;
}

TrackParams Slope(double grade_percent) {
  TrackParams track;
  track.grades = {{0.0, grade_percent}};
  return track;
}

double Dissipated(const LtdState<double>& s) {
  return std::accumulate(s.work.dissipated.begin(), s.work.dissipated.end(), 0.0);
}

TEST(LtdVehicle, MassesOfThePaper) {
  const LtdVehicle with(OreWagon(), true), without(OreWagon(), false);
  EXPECT_NEAR(with.inertia_kg - without.inertia_kg, kEquivalentMass, 0.05);  // half a unit of its last digit
  EXPECT_NEAR(without.inertia_kg, 160113.8, 1e-6);
  EXPECT_EQ(with.weight_n, without.weight_n);  // rotation has no weight
  EXPECT_NEAR(with.weight_n, 9.81 * 160113.8, 1e-6);
}

TEST(LtdVehicle, ImpossibleParametersAreRefused) {
  VehicleParams p = OreWagon();
  p.carbody.mass_kg = -1.0;
  EXPECT_THROW(LtdVehicle(p, true), std::invalid_argument);
}

TEST(StepLtd, StopsAConstantBrakeAfterVSquaredOver2A) {
  const LtdVehicle vehicle(PlainVehicle(), true);
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 430e3;
  const double deceleration = 0.46035 * 430e3 * 0.322 / vehicle.inertia_kg;
  for (const double v : {22.2, -13.0}) {
    LtdState<double> s;
    s.v_mps = v;
    constexpr double kDt = 1e-3;
    double t = 0.0;
    for (; s.v_mps != 0.0; t += kDt) StepLtd(vehicle, {}, loads, kDt, s);
    EXPECT_NEAR(t, std::abs(v) / deceleration, kDt);
    // Exact until the last step, within which the vehicle stops: at most a dt^2 / 8, beside rounding of 6e4
    // steps.
    EXPECT_NEAR(s.x_m, std::copysign(v * v / (2.0 * deceleration), v), deceleration * kDt * kDt / 8.0 + 1e-8);
    EXPECT_NEAR(s.work.dissipated[kBrakeShoes], 0.5 * vehicle.inertia_kg * v * v, 1e-9 * vehicle.inertia_kg * v * v);
  }
}

TEST(StepLtd, CoastsForEverWithoutResistance) {
  for (const LtdIntegrator integrator : kBoth) {
    const LtdVehicle vehicle(PlainVehicle(), true, integrator);
    LtdState<double> s;
    s.v_mps = 17.0;
    for (int i = 0; i < 100000; ++i) StepLtd(vehicle, {}, {}, 1e-3, s);
    EXPECT_EQ(s.v_mps, 17.0);
    EXPECT_NEAR(s.x_m, 1700.0, 1e-7);  // rounding of 1e5 additions
  }
}

TEST(StepLtd, StandsExactlyWhereTheBrakeHolds) {
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 430e3;  // 63.7 kN of shoe force at rest
  for (const LtdIntegrator integrator : kBoth) {
    const LtdVehicle vehicle(OreWagon(), true, integrator);
    for (const double grade : {2.0, -2.0, 4.0}) {  // 31.4 kN and 62.8 kN
      LtdState<double> s;
      s.v_mps = 0.3;
      for (int i = 0; i < 5000; ++i) StepLtd(vehicle, Slope(grade), loads, 1e-3, s);
      const double x = s.x_m;
      for (int i = 0; i < 90000; ++i) StepLtd(vehicle, Slope(grade), loads, 1e-3, s);
      EXPECT_EQ(s.v_mps, 0.0);
      EXPECT_EQ(s.x_m, x);
    }
  }
}

TEST(StepLtd, RunsAwayWhereTheBrakeCannotHold) {
  const LtdVehicle vehicle(PlainVehicle(), true);
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 430e3;
  LtdState<double> s;
  for (int i = 0; i < 10000; ++i) StepLtd(vehicle, Slope(-5.0), loads, 1e-3, s);
  const double acceleration = (0.05 * vehicle.weight_n - 0.46035 * 430e3 * 0.322) / vehicle.inertia_kg;
  EXPECT_NEAR(s.v_mps, 10.0 * acceleration, 1e-10);  // a constant force is integrated exactly, to rounding
  EXPECT_NEAR(s.x_m, 50.0 * acceleration, 1e-9);
}

TEST(StepLtd, ResistanceAloneHoldsAGentleGrade) {
  const LtdVehicle vehicle(OreWagon(), true);
  LtdState<double> s;
  for (int i = 0; i < 1000; ++i) StepLtd(vehicle, Slope(0.09), {}, 1e-3, s);
  EXPECT_EQ(s.x_m, 0.0);  // 0.9 N/kN against a starting resistance of 0.92 N/kN
  for (int i = 0; i < 1000; ++i) StepLtd(vehicle, Slope(0.10), {}, 1e-3, s);
  EXPECT_LT(s.x_m, 0.0);
}

// Error at t = 2 s of a vehicle on a spring of 1 rad/s, whose force is taken at the step's middle.
double SpringError(double dt) {
  const LtdVehicle vehicle(PlainVehicle(), true);
  LtdState<double> s;
  s.v_mps = 3.0;
  for (int i = 0; i < std::lround(2.0 / dt); ++i) {
    VehicleLoads<double> loads;
    loads.front_coupler_n = -vehicle.inertia_kg * (s.x_m + 0.5 * dt * s.v_mps);
    StepLtd(vehicle, {}, loads, dt, s);
  }
  return std::abs(s.x_m - 3.0 * std::sin(2.0));
}

TEST(StepLtd, PositionForcesConvergeWithTheSecondOrder) {
  for (const double dt : {0.1, 0.05, 0.025}) {
    const double order = std::log2(SpringError(dt) / SpringError(0.5 * dt));
    EXPECT_NEAR(order, 2.0, 0.02);  // the next term is of relative size dt^2
  }
}

// Error at t = 10 s of v' = -c v^2, v = v0 / (1 + c v0 t).
double DragError(double dt) {
  VehicleParams p = PlainVehicle();
  p.propulsion_resistance.quadratic_n_per_kn_kmh2 = 0.1;
  const LtdVehicle vehicle(p, false);
  const double c = 0.1e-3 * 9.81 * 3.6 * 3.6;
  LtdState<double> s;
  s.v_mps = 20.0;
  for (int i = 0; i < std::lround(10.0 / dt); ++i) StepLtd(vehicle, {}, {}, dt, s);
  return std::abs(s.v_mps - 20.0 / (1.0 + c * 20.0 * 10.0));
}

TEST(StepLtd, SpeedForcesConvergeWithTheFirst) {
  // Brakes and resistance are taken at the speed of the step's start: order 1, with a small constant.
  for (const double dt : {0.1, 0.05, 0.025}) {
    const double order = std::log2(DragError(dt) / DragError(0.5 * dt));
    EXPECT_NEAR(order, 1.0, 0.05);  // the next term is of relative size dt
  }
  EXPECT_LT(DragError(1e-3), 1e-3);
}

TEST(StepLtd, NewmarkIsLeapfrogHalfAStepApart) {
  const LtdVehicle by_leapfrog(OreWagon(), true);
  const LtdVehicle by_newmark(OreWagon(), true, LtdIntegrator::kNewmark);
  TrackParams hills;
  hills.grades = {{0.0, -1.0}, {30.0, 0.7}, {60.0, -0.4}, {110.0, 1.2}};
  constexpr double kDt = 1e-3;
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 40e3;
  LtdState<double> leapfrog, newmark;
  leapfrog.v_mps = newmark.v_mps = 12.0;
  newmark.x_m = 0.5 * kDt * leapfrog.v_mps;
  for (int i = 0; i < 20000; ++i) {
    loads.front_coupler_n = 1e4 * std::sin(1e-3 * i);
    StepLtd(by_leapfrog, hills, loads, kDt, leapfrog);
    StepLtd(by_newmark, hills, loads, kDt, newmark);
    // The same operations in another order: rounding, and a grade that one of both meets a rounding earlier.
    ASSERT_NEAR(newmark.v_mps, leapfrog.v_mps, 1e-9);
    ASSERT_NEAR(newmark.x_m, leapfrog.x_m + 0.5 * kDt * leapfrog.v_mps, 1e-9);
  }
}

TEST(StepLtd, TheLedgerCloses) {
  const LtdVehicle vehicle(OreWagon(), true);
  TrackParams hills;
  hills.grades = {{0.0, -1.0}, {40.0, 0.7}};
  LtdState<double> s;
  s.v_mps = 6.0;
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 60e3;
  loads.traction_n = 2e3;
  loads.dynamic_brake_n = 4e3;
  loads.curving_resistance_n = 500.0;
  const double initial = KineticEnergy(vehicle, s);
  double coupler_work = 0.0;
  for (int i = 0; i < 60000; ++i) {  // stops after some 40 s and is dragged on
    loads.front_coupler_n = i < 45000 ? 1e4 * std::sin(1e-3 * i) : 9e4;
    const double x = s.x_m;
    StepLtd(vehicle, hills, loads, 1e-3, s);
    coupler_work += loads.front_coupler_n * (s.x_m - x);
    for (const double lost : s.work.dissipated) ASSERT_GE(lost, 0.0);
  }
  for (const Dissipation element : {kBrakeShoes, kDynamicBrake, kRollingResistance, kCurvingResistance, kAirDrag}) {
    EXPECT_GT(s.work.dissipated[element], 0.0);
  }
  const double residual =
      KineticEnergy(vehicle, s) + Dissipated(s) - initial - s.work.gravity - s.work.traction - coupler_work;
  EXPECT_NEAR(residual, 0.0, 1e-11 * initial);  // an identity of the scheme: rounding of 6e4 steps
}

TEST(StepLtd, IsTheSameInBothDirections) {
  const LtdVehicle vehicle(OreWagon(), true);
  TrackParams track, mirrored;
  track.grades = {{-1e4, -1.0}, {40.0, 0.7}};
  mirrored.grades = {{-1e4, -0.7}, {-40.0, 1.0}};
  LtdState<double> s, back;
  s.v_mps = 8.0;
  back.v_mps = -8.0;
  VehicleLoads<double> loads, swapped;
  loads.cylinder_pressure_pa = swapped.cylinder_pressure_pa = 100e3;
  loads.front_coupler_n = swapped.rear_coupler_n = 3e4;
  loads.rear_coupler_n = swapped.front_coupler_n = 1e4;
  for (int i = 0; i < 30000; ++i) {
    StepLtd(vehicle, track, loads, 1e-3, s);
    StepLtd(vehicle, mirrored, swapped, 1e-3, back);
    ASSERT_EQ(s.x_m, -back.x_m);
    ASSERT_EQ(s.v_mps, -back.v_mps);
  }
}

}  // namespace
}  // namespace train_dynamics
