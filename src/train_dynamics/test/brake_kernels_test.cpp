// The laws of cylinders over the lanes of each instruction set, held against the scalar ones.

#include "train_dynamics/brake/brake_kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "paper_vehicle.h"
#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

class BrakeKernelsTest : public testing::TestWithParam<BrakeKernels> {};

TEST_P(BrakeKernelsTest, FillCylindersAsTheScalarLawDoes) {
  std::vector<double> centres;
  for (int i = 0; i < 16; ++i) centres.push_back(-10.5 * i);
  AirBrakeParams params = LoadPart<BrakeSystemParams>("brakes/calibrated.yaml").empirical;
  params.sources = {{"lead", 1}};
  const AirBrake brake(params, {{0.0, BrakeCommandKind::kEmergency}, {9.0, BrakeCommandKind::kRelease}}, centres);
  const BrakePhases phases = brake.Phases();
  for (const double time_s : {0.0, 0.3, 5.0, 9.5, 30.0}) {
    std::vector<double> law(16), target(16), gap(16), decay(16), pressure(16);
    GetParam().cylinder_pressures(phases, time_s, 16, law.data());
    const GapArrays gaps = {target.data(), gap.data(), decay.data()};
    GetParam().cylinder_gaps(phases, time_s, 0.01, 16, gaps);
    GetParam().close_cylinder_gaps(3, 16, gaps, pressure.data());
    for (int i = 0; i < 16; ++i) {
      const CylinderGap<double> expected = CylinderGapAt<double>(phases, i, time_s);
      EXPECT_EQ(law[i], CylinderPressure<double>(phases, i, time_s));
      EXPECT_EQ(target[i], expected.target_pa);
      EXPECT_EQ(decay[i], Exp(-expected.rate_per_s * 0.01));
      EXPECT_EQ(gap[i], ((expected.gap_pa * decay[i]) * decay[i]) * decay[i]);
      EXPECT_EQ(pressure[i], target[i] + gap[i]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BrakeKernelsTest, testing::ValuesIn(AllBrakeKernels()));

}  // namespace
}  // namespace train_dynamics
