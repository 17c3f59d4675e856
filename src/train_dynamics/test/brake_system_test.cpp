// The closed set of brake systems: which one a scenario gets, and that its state is saved, restored and digested.

#include "train_dynamics/brake/brake_system.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "paper_vehicle.h"

namespace train_dynamics {
namespace {

std::vector<double> StateOf(BrakeSystem& brake) {
  std::vector<double> state;
  brake.ForEachField([&](double field) { state.push_back(field); });
  return state;
}

TEST(BrakeSystem, TheEmpiricalBrakeGivesTheLawsPressures) {
  const auto params = LoadPart<BrakeSystemParams>("brakes/single_vehicle.yaml");
  const std::vector<BrakeCommand> commands = {{0.5, BrakeCommandKind::kApply, 100.0}};
  const std::vector<double> centres = {0.0, -10.5, -21.0};
  BrakeSystem brake(params, commands, centres, {0.001, 10});
  std::vector<double> pressure_pa, law_pa;
  for (const double time_s : {0.0, 0.5005, 7.0, 40.0}) {
    brake.PressuresAt(time_s, pressure_pa);
    AirBrake(params.empirical, commands, centres).PressuresAt(time_s, law_pa);
    ASSERT_EQ(pressure_pa.size(), 3u);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(pressure_pa[i], law_pa[i], 1e-8) << time_s;  // rounding of 250 kPa
  }
  EXPECT_EQ(StateOf(brake), std::vector<double>());
}

TEST(BrakeSystem, MovedAheadItShowsLaterTimes) {
  BrakeSystem table(PressureTable({0.0, 10.0}, {{0.0, 1000.0}}));
  std::vector<double> pressure_pa;
  table.PressuresAt(2.0, pressure_pa);
  EXPECT_EQ(pressure_pa, std::vector<double>{200.0});
  table.MoveAhead(5.0);
  table.PressuresAt(2.0, pressure_pa);
  EXPECT_EQ(pressure_pa, std::vector<double>{700.0});
  EXPECT_EQ(StateOf(table), std::vector<double>());
}

/// Three wagons whose second has 150 kPa trapped: applied at 0.5 s, released at 20 s.
std::vector<std::vector<double>> PressuresWithTrappedAir(const std::string& brake_file) {
  const auto params = LoadPart<BrakeSystemParams>(brake_file);
  const std::vector<BrakeCommand> commands = {{0.5, BrakeCommandKind::kApply, 100.0},
                                              {20.0, BrakeCommandKind::kRelease}};
  const std::vector<double> centres = {0.0, -10.5, -21.0}, lengths(3, 10.5);
  BrakeSystem brake(params, commands, centres, {0.001, 10}, lengths);
  BrakeSystem plain(params, commands, centres, {0.001, 10}, lengths);
  brake.TrapAir(1, 150e3);
  std::vector<std::vector<double>> all;
  std::vector<double> with_pa, plain_pa;
  for (const double time_s : {0.0, 5.0, 19.0, 120.0}) {
    brake.PressuresAt(time_s, with_pa);
    plain.PressuresAt(time_s, plain_pa);
    all.push_back(with_pa);
    all.push_back(plain_pa);
  }
  if (brake.pneumatic()) {
    EXPECT_NEAR(brake.pneumatic()->valve(1).cylinder_pa, 101325.0 + 150e3, 1e-6);
  }
  return all;
}

TEST(BrakeSystem, TrappedAirStaysAndTheOthersGoOn) {
  const auto empirical = PressuresWithTrappedAir("brakes/single_vehicle.yaml");
  for (std::size_t i = 0; i < empirical.size(); i += 2) {
    EXPECT_EQ(empirical[i][1], 150e3);
    EXPECT_EQ(empirical[i][0], empirical[i + 1][0]);
    EXPECT_EQ(empirical[i][2], empirical[i + 1][2]);
  }
  // The valve that is cut out takes no air from the pipe: its neighbours see a lighter load, no other.
  const auto pneumatic = PressuresWithTrappedAir("brakes/ab_head_end.yaml");
  for (std::size_t i = 0; i < pneumatic.size(); i += 2) {
    EXPECT_EQ(pneumatic[i][1], 150e3);
    EXPECT_NEAR(pneumatic[i][0], pneumatic[i + 1][0], 0.05 * pneumatic[i + 1][0] + 1.0);
  }
  EXPECT_GT(pneumatic[4][0], 150e3) << "applied";
  EXPECT_LT(pneumatic[6][0], 5e3) << "released";
}

}  // namespace
}  // namespace train_dynamics
