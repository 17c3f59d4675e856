// From cylinder pressure to shoe force, and the laws of shoe friction.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "ride.h"
#include "strict_config/validate.h"
#include "train_dynamics/brake/shoe_friction.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

constexpr double kTonneForce = 9810.0;  // [N]
constexpr double kPsi = 6894.757293168;

ShoeFrictionParams By(ShoeFrictionLaw law) {
  ShoeFrictionParams p;
  p.law = law;
  return p;
}

BrakeRigging RiggingOf(const BrakeRiggingParams& p) { return {p, 160e3, 160e3 * 9.81}; }

TEST(ShoeFrictionLaw, CompositionAtOneShoeForceIsEq3) {
  const ShoeFrictionParams& eq3 = OreWagon().brake_rigging.shoe_friction;
  // 0.44 (K + 20) / (4 K + 20) = 0.322
  for (double v = -40.0; v <= 40.0; v += 0.37) {
    EXPECT_NEAR(ShoeFrictionByLaw(By(ShoeFrictionLaw::kComposition), v, 2.783018867924528 * kTonneForce),
                ShoeFriction(eq3, v), 1e-12);
  }
}

TEST(ShoeFrictionLaw, ValuesOfAnIndependentProgram) {
  const double at_80 = 80.0 / 3.6;
  const double composition[] = {0.28565, 0.25650, 0.23464};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(ShoeFrictionByLaw(By(ShoeFrictionLaw::kComposition), at_80, (i + 1) * kTonneForce), composition[i],
                5e-6);
  }
  const double cast_iron[] = {0.30244, 0.14114, 0.10888, 0.09505};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(ShoeFrictionByLaw(By(ShoeFrictionLaw::kCastIron), 40.0 / 3.6 * i, 20e3), cast_iron[i], 5e-6);
  }
  ShoeFrictionParams tos = By(ShoeFrictionLaw::kTos);
  const double temperature_c[] = {20.0, 149.0, 216.0, 400.0}, at_40[] = {0.3943, 0.3693, 0.2730, 0.2026};
  for (int i = 0; i < 4; ++i) {
    tos.shoe_temperature_c = temperature_c[i];
    EXPECT_NEAR(ShoeFrictionByLaw(tos, 40.0 / 3.6, 20e3), at_40[i], 3e-4) << temperature_c[i];  // whole degrees
  }
}

// AAR Train Operations Simulator at 300 F (Low & Garg 1977, as in the manual of the Train Performance Simulator).
TEST(ShoeFrictionLaw, TosReproducesItsPublishedTable) {
  const double mph[] = {1, 3, 5, 7, 10, 20, 30, 40, 50, 60, 70, 80};
  const double mu[] = {0.5568, 0.5028, 0.4700, 0.4479, 0.4249, 0.3820, 0.3585, 0.3425, 0.3305, 0.3210, 0.3131, 0.3065};
  ShoeFrictionParams p = By(ShoeFrictionLaw::kTos);
  p.shoe_temperature_c = (300.0 - 32.0) / 1.8;
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(ShoeFrictionByLaw(p, 0.44704 * mph[i], 1e4), mu[i], 1e-4) << mph[i];
  EXPECT_EQ(ShoeFrictionByLaw(p, 0.0, 1e4), ShoeFrictionByLaw(p, 0.44704, 1e4));  // below 1 mph
}

TEST(ShoeFrictionLaw, TableIsLinearInSpeedAndForceAndHoldsItsEnds) {
  ShoeFrictionParams p = By(ShoeFrictionLaw::kTable);
  p.table.speed_kmh = {0.0, 36.0, 72.0};
  p.table.curves = {{10.0, {0.4, 0.3, 0.2}}, {20.0, {0.3, 0.2, 0.1}}};
  EXPECT_NO_THROW(strict_config::Validate(p));
  EXPECT_NEAR(ShoeFrictionByLaw(p, 5.0, 10e3), 0.35, 1e-15);
  EXPECT_NEAR(ShoeFrictionByLaw(p, -5.0, 15e3), 0.30, 1e-15);
  EXPECT_NEAR(ShoeFrictionByLaw(p, 40.0, 5e3), 0.2, 1e-15);
  EXPECT_NEAR(ShoeFrictionByLaw(p, 40.0, 50e3), 0.1, 1e-15);
  p.table.curves[1].friction_coefficient.pop_back();
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
}

TEST(ShoeFrictionLaw, WetShoesHaveAShareOfIt) {
  ShoeFrictionParams p = By(ShoeFrictionLaw::kComposition);
  const double dry = ShoeFrictionByLaw(p, 10.0, 2e4);
  p.wet_factor = 0.8;
  EXPECT_NEAR(ShoeFrictionByLaw(p, 10.0, 2e4), 0.8 * dry, 1e-15);
}

TEST(ShoeFrictionLaw, GivesTheBitsOfDoubleInLanes) {
  using Pack = Lanes<4>;
  ShoeFrictionParams table = By(ShoeFrictionLaw::kTable);
  table.table.speed_kmh = {0.0, 36.0, 72.0};
  table.table.curves = {{10.0, {0.4, 0.3, 0.2}}, {20.0, {0.3, 0.2, 0.1}}};
  for (const ShoeFrictionParams& p :
       {By(ShoeFrictionLaw::kComposition), By(ShoeFrictionLaw::kCastIron), By(ShoeFrictionLaw::kTos), table}) {
    for (double v = -30.0; v < 30.0; v += 0.713) {
      const double speeds[] = {v, 1.3 * v, 0.0, v + 1.0}, loads[] = {0.0, 1e4, 2e4, 2.7e4};
      double together[4];
      Store(ShoeFrictionByLaw(p, Load<Pack>(speeds), Load<Pack>(loads)), together);
      for (int i = 0; i < 4; ++i) EXPECT_EQ(together[i], ShoeFrictionByLaw(p, speeds[i], loads[i]));
    }
  }
}

TEST(Log, AgreesWithTheLibrary) {
  EXPECT_EQ(Log(1.0), 0.0);
  for (double x = 1e-300; x < 1e300; x *= 1.37) {
    EXPECT_NEAR(Log(x), std::log(x), 1.5e-15 * std::max(1.0, std::abs(std::log(x)))) << x;
  }
  for (double x = 0.5; x < 2.0; x += 1e-3) EXPECT_NEAR(Log(x), std::log(x), 1.5e-15) << x;
  for (const double x : {0.0, -1.0, 1e-310}) EXPECT_TRUE(std::isnan(Log(x)));
}

TEST(BrakeRigging, EfficiencyOfTheTrainOperationsSimulator) {
  EXPECT_NEAR(TosRiggingEfficiency(30.0 * kPsi), 0.5571, 5e-5);
  EXPECT_NEAR(TosRiggingEfficiency(64.0 * kPsi), 0.6297, 5e-5);
  EXPECT_NEAR(TosRiggingEfficiency(77.0 * kPsi), 0.6452, 5e-5);
  EXPECT_EQ(TosRiggingEfficiency(3.0 * kPsi), TosRiggingEfficiency(10.0 * kPsi));
}

TEST(BrakeRigging, CylinderAndLeversByHand) {
  BrakeRiggingParams p = OreWagon().brake_rigging;
  p.shoe_load = ShoeLoadForm::kCylinder;
  p.cylinder.piston_area_m2 = 0.08;
  p.cylinder.return_spring_n = 1000.0;
  p.cylinder.leverage_ratio = 9.0;
  p.cylinder.efficiency = 0.65;
  EXPECT_NO_THROW(strict_config::Validate(p));
  EXPECT_EQ(ShoeLoad(RiggingOf(p), 1e4), 0.0);  // the spring holds
  EXPECT_NEAR(ShoeLoad(RiggingOf(p), 4e5), (0.08 * 4e5 - 1000.0) * 9.0 * 0.65, 1e-9);
  p.cylinder.efficiency.reset();
  EXPECT_NEAR(ShoeLoad(RiggingOf(p), 64.0 * kPsi),
              (0.08 * 64.0 * kPsi - 1000.0) * 9.0 * std::sqrt(std::log(58.0)) / 3.2, 1e-6);
}

TEST(BrakeRigging, NetBrakingRatioAndLoadSensing) {
  BrakeRiggingParams p = OreWagon().brake_rigging;
  p.shoe_load = ShoeLoadForm::kNetBrakingRatio;
  p.net_braking_ratio = {0.11, 430.0};
  EXPECT_NEAR(ShoeLoad(RiggingOf(p), 430e3), 0.11 * 160e3 * 9.81, 1e-6);
  p.load_sensing = LoadSensingParams();
  p.load_sensing->full_mass_kg = 160e3;
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
  p.shoe_load = ShoeLoadForm::kPerPressure;
  const auto load = [&p](double mass_kg) { return ShoeLoad(BrakeRigging(p, mass_kg, 9.81 * mass_kg), 430e3); };
  const double full = 0.46035 * 430e3;
  EXPECT_NEAR(load(160e3), full, 1e-9);
  EXPECT_NEAR(load(200e3), full, 1e-9);
  EXPECT_NEAR(load(80e3), 0.5 * full, 1e-9);
  EXPECT_NEAR(load(28.5e3), 0.3 * full, 1e-9);
  p.load_sensing->kind = LoadSensingKind::kTwoStep;
  p.load_sensing->changeover_mass_kg = 50e3;
  EXPECT_NEAR(load(28.5e3), 0.5 * full, 1e-9);
  EXPECT_NEAR(load(80e3), full, 1e-9);
  p.cut_out = true;
  EXPECT_EQ(load(80e3), 0.0);
}

// Eq 3 at constant pressure, no resistance:
//   s = (m + m_e) / (12.96 C p mu_0) [k^2 - 150 k + 22500 ln(1 + k / 150)],  t = (m + m_e) / (3.6 C p mu_0) [2 k - 150
//   ln(1 + k / 150)]
TEST(BrakeRigging, StopAtConstantPressure) {
  VehicleParams p = OreWagon();
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  const LtdVehicle vehicle(p, true);
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 430e3;
  constexpr double kDt = 1e-3, kKmh = 80.0;
  LtdState<double> s;
  s.v_mps = kKmh / 3.6;
  double t = 0.0;
  for (; s.v_mps > 0.0; t += kDt) StepLtd(vehicle, {}, loads, kDt, s);
  const double force = 0.46035 * 430e3 * 0.322, log = std::log(1.0 + kKmh / 150.0);
  const double way = vehicle.inertia_kg / (12.96 * force) * (kKmh * kKmh - 150.0 * kKmh + 22500.0 * log);
  const double time = vehicle.inertia_kg / (3.6 * force) * (2.0 * kKmh - 150.0 * log);
  EXPECT_NEAR(way, 834.847, 5e-4);
  EXPECT_NEAR(time, 71.7295, 5e-5);
  EXPECT_NEAR(s.x_m, way, 0.5 * kDt * kKmh / 3.6);  // friction is that of each step's start
  EXPECT_NEAR(t, time, kDt);
}

// Coasting of the loaded ore wagon and its end on a fall, by the paper's resistance.
TEST(PropulsionResistance, CoastAndTerminalSpeed) {
  const LtdVehicle vehicle(OreWagon(), true);
  constexpr double kDt = 1e-2;
  LtdState<double> s;
  s.v_mps = 80.0 / 3.6;
  double t = 0.0;
  for (; s.v_mps > 40.0 / 3.6; t += kDt) StepLtd(vehicle, {}, VehicleLoads<double>{}, kDt, s);
  EXPECT_NEAR(t, 738.810, kDt);
  EXPECT_NEAR(s.x_m, 11990.32, kDt * 40.0 / 3.6);
  TrackParams fall;
  fall.grades = {{0.0, -0.5}};
  const Track track(fall);
  for (int i = 0; i < 2000000; ++i) StepLtd(vehicle, track, VehicleLoads<double>{}, kDt, s);
  EXPECT_NEAR(3.6 * s.v_mps, 162.483, 5e-4);
}

// A hand brake is a constant force, whatever the air does: it holds up to its share of the weight.
TEST(HandBrake, HoldsAGradeInBothModels) {
  VehicleParams p = OreWagon();
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  p.brake_rigging.hand_brake_ratio = 0.02;
  for (const double grade : {1.5, 2.5}) {
    TrackParams fall;
    fall.grades = {{0.0, -grade}};
    const LtdVehicle vehicle(p, true);
    LtdState<double> s;
    for (int i = 0; i < 10000; ++i) StepLtd(vehicle, fall, VehicleLoads<double>{}, 1e-3, s);
    Ride ride(p, fall, 0.0);
    ride.Run(10.0);
    if (grade < 2.0) {
      EXPECT_EQ(s.x_m, 0.0);
      EXPECT_LT(std::abs(ride.Distance()), 0.02);  // it leans into its springs
      EXPECT_LT(std::abs(ride.Speed()), 1e-3);
    } else {
      const double a = (9.81 * p.TotalMass() * 0.005) / vehicle.inertia_kg;
      EXPECT_NEAR(s.v_mps, 10.0 * a, 1e-9);
      EXPECT_NEAR(ride.Speed(), 10.0 * a, 0.02 * 10.0 * a);
      EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy + 1.0);
    }
  }
}

// Constant friction under a constant load, without resistance: F = F_0 (f + (1 - f) E / E_w) with dE = F dx, so that
// E(x) = E_w f / (1 - f) (exp((1 - f) F_0 x / E_w) - 1), and all ice is gone after E_w ln(1 / f) / ((1 - f) F_0).
TEST(IcyShoes, WarmUpAsTheClosedFormSays) {
  VehicleParams p = OreWagon();
  p.propulsion_resistance = {0.0, 0.0, 0.0};
  p.brake_rigging.shoe_friction.law = ShoeFrictionLaw::kTable;
  p.brake_rigging.shoe_friction.table = {{0.0}, {{20.0, {0.25}}}};
  p.brake_rigging.shoe_friction.icy = IcyShoesParams{0.6, 1.5e6};
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 400e3;
  const double force = 0.25 * 0.46035 * 400e3, all_j = 8.0 * 1.5e6;
  const double gone_m = all_j * std::log(1.0 / 0.6) / (0.4 * force);
  const auto energy_at = [&](double x) {
    return x < gone_m ? all_j * 1.5 * (std::exp(0.4 * force * x / all_j) - 1.0) : all_j + force * (x - gone_m);
  };
  EXPECT_NEAR(energy_at(gone_m), all_j, 1e-6 * all_j);
  const LtdVehicle vehicle(p, true);
  LtdState<double> s;
  s.v_mps = 80.0 / 3.6;
  Ride ride(p, TrackParams(), 80.0 / 3.6);
  ride.loads = loads;
  for (const double x : {100.0, 200.0, gone_m, 500.0}) {
    while (s.x_m < x) StepLtd(vehicle, {}, loads, 1e-3, s);
    EXPECT_NEAR(s.work.dissipated[kBrakeShoes], energy_at(s.x_m), 1e-4 * energy_at(x)) << x;  // steps
    while (ride.Distance() < x) ride.Step(1e-3);
    // Creep: the tread goes a little less far than the vehicle.
    EXPECT_NEAR(ride.state.work.dissipated[kBrakeShoes], energy_at(ride.Distance()), 3e-3 * energy_at(x)) << x;
  }
}

// Composition shoes in the 2D model: the stop of the LTD vehicle with the same rigging.
TEST(ShoeFrictionLaw, TwoDimensionalStopIsThatOfLtd) {
  VehicleParams p = OreWagon();
  p.brake_rigging.shoe_friction.law = ShoeFrictionLaw::kComposition;
  p.brake_rigging.shoe_load = ShoeLoadForm::kCylinder;
  p.brake_rigging.cylinder.piston_area_m2 = 0.08;
  p.brake_rigging.cylinder.leverage_ratio = 9.0;
  for (const FrictionSpeed by : {FrictionSpeed::kVehicle, FrictionSpeed::kTread}) {
    p.brake_rigging.friction_speed = by;
    VehicleLoads<double> loads;
    loads.cylinder_pressure_pa = 350e3;
    const LtdVehicle vehicle(p, true);
    LtdState<double> s;
    s.v_mps = 15.0;
    while (s.v_mps > 0.0) StepLtd(vehicle, {}, loads, 1e-3, s);
    Ride ride(p, TrackParams(), 15.0);
    ride.loads = loads;
    while (ride.Speed() > 0.01) ride.Step(1e-3);
    EXPECT_NEAR(ride.Distance(), s.x_m, 2e-3 * s.x_m);  // creep: the tread is slower than the vehicle
    EXPECT_LT(std::abs(ride.Residual()), 1e-6 * ride.initial_energy);
  }
}

}  // namespace
}  // namespace train_dynamics
