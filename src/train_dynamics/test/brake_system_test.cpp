// The closed set of brake systems: which one a scenario gets, and that its state is saved, restored and digested.

#include "train_dynamics/brake/brake_system.h"

#include <gtest/gtest.h>

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
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(pressure_pa[i], law_pa[i], 1e-8) << time_s;  // rounding of 250 kPa
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

}  // namespace
}  // namespace train_dynamics
