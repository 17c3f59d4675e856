// A batch is only a way to step wagons fast: whatever the instruction set and the number of lanes, each wagon
// moves as StepWagon<double> moves it, bit for bit.
#include "train_dynamics/vehicle/wagon_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "paper_vehicle.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

class WagonBatchTest : public testing::TestWithParam<WagonKernel> {
 protected:
  /// A number that fills no pack exactly, so that the last one has spare lanes.
  static std::vector<WagonState<double>> ElevenWagons(const Wagon& wagon) {
    std::vector<WagonState<double>> states;
    for (int i = 0; i < 11; ++i) states.push_back(StaticEquilibrium(wagon, -10.5 * i, 22.0 - 2.0 * i));
    return states;
  }
};

TEST_P(WagonBatchTest, MovesEachWagonAsTheScalarStepDoes) {
  const Wagon wagon(OreWagon());
  TrackParams track;
  track.dips = {{5.0, 0.03, 10.0}};
  std::vector<WagonState<double>> states = ElevenWagons(wagon);
  WagonBatch batch(wagon, GetParam(), states);
  ASSERT_EQ(11, batch.size());
  for (int exchange = 0; exchange < 200; ++exchange) {
    const bool with_output = exchange == 199;
    std::vector<WagonOutput<double>> outputs(states.size());
    for (int i = 0; i < batch.size(); ++i) {
      VehicleLoads<double> loads;
      loads.front_coupler_n = 1e5 * std::sin(0.1 * exchange + i);
      loads.rear_coupler_n = 5e4 * i;
      loads.cylinder_pressure_pa = 3e3 * exchange;
      batch.SetLoads(i, loads.front_coupler_n, loads.rear_coupler_n, loads.cylinder_pressure_pa);
      for (int step = 0; step < 5; ++step) StepWagon(wagon, track, loads, 1e-3, states[i], &outputs[i]);
    }
    batch.Advance(track, 1e-3, 5, with_output);
    for (int i = 0; i < batch.size(); ++i) {
      ASSERT_EQ(CouplerHead(wagon, states[i].position), batch.HeadDisplacement(i)) << "wagon " << i;
      ASSERT_EQ(CouplerHead(wagon, states[i].velocity), batch.HeadVelocity(i)) << "wagon " << i;
      ASSERT_TRUE(batch.IsSound(i));
      if (!with_output) continue;
      const WagonState<double> s = batch.State(i);
      EXPECT_EQ(states[i].position.z, s.position.z);
      EXPECT_EQ(states[i].position.pitch, s.position.pitch);
      EXPECT_EQ(states[i].velocity.x, s.velocity.x);
      EXPECT_EQ(states[i].work.dissipated, s.work.dissipated);
      EXPECT_EQ(outputs[i].creep_force_n, batch.Output(i).creep_force_n);
      EXPECT_EQ(outputs[i].wedge_friction_n, batch.Output(i).wedge_friction_n);
    }
  }
}

TEST_P(WagonBatchTest, ReportsTheWagonThatIsNotSound) {
  const Wagon wagon(OreWagon());
  std::vector<WagonState<double>> states = ElevenWagons(wagon);
  states[6].velocity.z[kFrontBolster] = std::numeric_limits<double>::quiet_NaN();
  WagonBatch batch(wagon, GetParam(), states);
  batch.Advance({}, 1e-3, 1, false);
  for (int i = 0; i < batch.size(); ++i) EXPECT_EQ(i != 6, batch.IsSound(i)) << "wagon " << i;
}

INSTANTIATE_TEST_SUITE_P(AllKernels, WagonBatchTest, testing::ValuesIn(WagonKernels()),
                         [](const auto& kernel) { return std::string(kernel.param.instruction_set); });

}  // namespace
}  // namespace train_dynamics
