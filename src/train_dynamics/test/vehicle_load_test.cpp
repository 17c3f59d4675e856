// Vehicles that are one mass, and what vehicles carry: against masses counted by hand, and against vehicles with
// bodies.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/vehicle/ltd_vehicle.h"

namespace train_dynamics {
namespace {

VehicleParams Tank(double load_fraction) {
  VehicleParams tank;
  tank.length_m = 16.0;
  tank.mass_kg = 24000.0;
  tank.rotating_mass_kg = 2800.0;
  tank.load.emplace();
  tank.load->mass_kg = 66000.0;
  tank.load_fraction = load_fraction;
  const VehicleParams paper = OreWagon();
  tank.brake_rigging = paper.brake_rigging;
  tank.propulsion_resistance = paper.propulsion_resistance;
  return tank;
}

TEST(OneMass, WeighsWhatItIsAndWhatItCarries) {
  EXPECT_EQ(Tank(0.0).TotalMass(), 24000.0);
  EXPECT_EQ(Tank(0.5).TotalMass(), 57000.0);
  EXPECT_EQ(Tank(1.0).TotalMass(), 90000.0);
  VehicleParams full = Tank(1.0);
  full.load_fraction.reset();  // none: all of it
  EXPECT_EQ(full.TotalMass(), 90000.0);
  EXPECT_EQ(EquivalentRotationalMass(full), 2800.0);
  EXPECT_EQ(full.Wheelsets(), 4);
  full.axles = 2;
  EXPECT_EQ(full.Wheelsets(), 2);
}

TEST(OneMass, RunsAsTheVehicleWithBodiesOfTheSameMass) {
  const VehicleParams bodies = OreWagon();
  VehicleParams one = bodies;
  one.mass_kg = bodies.TotalMass();
  one.rotating_mass_kg = EquivalentRotationalMass(bodies);
  one.carbody = BodyParams();
  one.wheelset = WheelsetParams();
  const LtdVehicle a(bodies, true), b(one, true);
  TrackParams hills;
  hills.grades = {{0.0, -1.0}, {30.0, 0.7}};
  const Track track(hills);
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = 2e5;
  LtdState<double> one_state, other_state;
  one_state.v_mps = other_state.v_mps = 12.0;
  for (int i = 0; i < 5000; ++i) {
    StepLtd<double>(a, track, loads, 1e-3, one_state, nullptr);
    StepLtd<double>(b, track, loads, 1e-3, other_state, nullptr);
  }
  EXPECT_GT(one_state.x_m, 50.0);
  EXPECT_EQ(one_state.x_m, other_state.x_m);
  EXPECT_EQ(one_state.v_mps, other_state.v_mps);
}

TEST(Load, MovesTheCarbodysCentreAndInertia) {
  VehicleParams wagon = OreWagon();
  const BodyParams empty = wagon.carbody;
  wagon.load.emplace();
  wagon.load->mass_kg = 50000.0;
  wagon.load->cg_height_m = 2.5;
  wagon.load->pitch_inertia_kgm2 = 4e5;
  wagon.load_fraction = 0.4;
  const BodyParams both = wagon.LoadedCarbody();
  // The common CG is where the moments of the weights vanish; inertia about the rail by Steiner, and back.
  const double load = 0.4 * 50000.0;
  EXPECT_DOUBLE_EQ(both.mass_kg, empty.mass_kg + load);
  EXPECT_NEAR(empty.mass_kg * (empty.cg_height_m - both.cg_height_m) + load * (2.5 - both.cg_height_m), 0.0, 1e-6);
  const double about_rail =
      empty.pitch_inertia_kgm2 + empty.mass_kg * empty.cg_height_m * empty.cg_height_m + 0.4 * 4e5 + load * 2.5 * 2.5;
  EXPECT_NEAR(both.pitch_inertia_kgm2 + both.mass_kg * both.cg_height_m * both.cg_height_m, about_rail,
              1e-12 * about_rail);
  EXPECT_DOUBLE_EQ(wagon.TotalMass(), OreWagon().TotalMass() + load);
  wagon.load_fraction = 0.0;
  EXPECT_EQ(wagon.LoadedCarbody().mass_kg, empty.mass_kg);
  EXPECT_EQ(wagon.LoadedCarbody().cg_height_m, empty.cg_height_m);
  EXPECT_EQ(wagon.LoadedCarbody().pitch_inertia_kgm2, empty.pitch_inertia_kgm2);
}

std::string RefusalOf(const VehicleParams& vehicle) {
  try {
    strict_config::Validate(vehicle);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Load, ThatCannotBeIsRefused) {
  VehicleParams wagon = OreWagon();
  EXPECT_EQ(RefusalOf(wagon), "");
  wagon.load_fraction = 0.5;
  EXPECT_NE(RefusalOf(wagon).find("load_fraction needs load"), std::string::npos) << RefusalOf(wagon);
  wagon.load.emplace();
  wagon.load->mass_kg = 1000.0;
  EXPECT_NE(RefusalOf(wagon).find("load must have cg_height_m and pitch_inertia_kgm2"), std::string::npos)
      << RefusalOf(wagon);
  VehicleParams tank = Tank(1.5);
  EXPECT_NE(RefusalOf(tank).find("load_fraction must be in [0, 1]"), std::string::npos) << RefusalOf(tank);
  EXPECT_EQ(RefusalOf(Tank(0.3)), "");
}

}  // namespace
}  // namespace train_dynamics
