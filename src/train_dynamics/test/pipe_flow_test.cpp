#include "train_dynamics/brake/pneumatic/pipe_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "published.h"

namespace train_dynamics {
namespace {

constexpr double kTemperature = 293.15;
constexpr double kCharged = 600e3;  // absolute

PipeGrid Grid(double length_m, double diameter_m, int cells, double branch_per_m_m3 = 0.0,
              PipeFriction friction = PipeFriction()) {
  const double dx = length_m / cells;
  return PipeGrid(diameter_m, kTemperature, std::vector<double>(cells, dx),
                  std::vector<double>(cells, branch_per_m_m3 * dx), std::move(friction));
}

// Runs until `end_s`; `side(t, dt, flow)` acts after every step.
void Simulate(const PipeGrid& grid, double dt_s, double end_s, PipeFlow& flow,
              const std::function<void(double, double, PipeFlow&)>& side) {
  const long steps = std::lround(end_s / dt_s);
  for (long h = 0; h < steps; ++h) {
    Advance(grid, dt_s, flow);
    side(static_cast<double>(h + 1) * dt_s, dt_s, flow);
  }
}

// A grid whose first cell, where the pressure is prescribed, has its centre at x = 0.
PipeGrid GridFromCentre(double length_m, double diameter_m, int cells, double branch_per_m_m3 = 0.0,
                        PipeFriction friction = PipeFriction()) {
  const double dx = length_m / (cells - 0.5);
  return PipeGrid(diameter_m, kTemperature, std::vector<double>(cells, dx),
                  std::vector<double>(cells, branch_per_m_m3 * dx), std::move(friction));
}

// Time at which the pressure at x (between cell centres) has fallen by `drop`.
class FallTime {
 public:
  FallTime(const PipeGrid& grid, double x_m, double drop_pa, double first_centre = 0.5) : drop_(drop_pa) {
    const double at = x_m / grid.cell_length_m[0] - first_centre;
    cell_ = std::min(static_cast<int>(std::floor(at)), grid.cells() - 2);
    share_ = std::min(at - cell_, 1.0);
  }
  void See(double t, double dt, const PipeFlow& flow) {
    const double p = (1.0 - share_) * flow.pressure_pa[cell_] + share_ * flow.pressure_pa[cell_ + 1];
    const double fall = kCharged - p;
    if (std::isnan(time_) && fall >= drop_) time_ = t - dt * (fall - drop_) / (fall - before_);
    before_ = fall;
  }
  double time() const { return time_; }

 private:
  double drop_, share_, before_ = 0.0, time_ = std::nan("");
  int cell_;
};

TEST(Air, TheNozzleFunctionIsItsFormula) {
  for (double r = 0.0; r <= 1.0; r += 1e-3) {
    const double ratio = std::max(r, std::pow(2.0 / 2.4, 3.5));
    const double exact = std::sqrt(std::max(0.0, std::pow(ratio, 2.0 / 1.4) - std::pow(ratio, 2.4 / 1.4)));
    EXPECT_NEAR(NozzleFunction(r), exact, 1e-8) << r;
  }
}

TEST(Air, AnOpeningNeverOvershootsAndKeepsTheAir) {
  double p1 = 600e3, p2 = 500e3;
  const double passed = Pass(1.0, 1e3, p1, 0.04, p2, 0.01);
  EXPECT_NEAR(p1, p2, 1e-6);
  EXPECT_NEAR(p1 * 0.04 + p2 * 0.01, 600e3 * 0.04 + 500e3 * 0.01, 1e-6);
  EXPECT_GT(passed, 0.0);
  EXPECT_EQ(PassOneWay(1.0, 1.0, p2 = 400e3, 0.04, p1, 0.01), 0.0);
}

TEST(PipeFriction, IsTheLaw) {
  const PipeFriction friction;
  for (double re = 10.0; re < 2e5; re *= 1.003) {
    const double f = re < 2000.0    ? 64.0 / re
                     : re < 4000.0  ? 0.000137 * std::pow(re, 0.717)
                     : re < 40000.0 ? 0.13977 * std::pow(re, -0.11781)
                                    : 0.04;
    // The law jumps by 0.4 % at 4000, the table does not.
    EXPECT_NEAR(friction.FactorTimesReynolds(re) / (f * re), 1.0, re > 3950.0 && re < 4050.0 ? 5e-3 : 3e-4) << re;
  }
}

// (A) A step of 1 kPa without friction travels at the isothermal speed of sound, c = 290.084 m/s.
TEST(PipeFlow, AStepTravelsAtTheIsothermalSpeedOfSound) {
  for (const auto& [cells, expected] :
       std::vector<std::pair<int, double>>{{200, 3.4645}, {400, 3.4602}, {800, 3.4580}}) {
    const PipeGrid grid = GridFromCentre(1000.0, 0.032, cells, 0.0, PipeFriction(1e-12));
    PipeFlow flow(grid, kCharged);
    FallTime tail(grid, 1000.0, 1e3, 0.0);
    Simulate(grid, grid.LongestStep(), 4.0, flow, [&](double t, double dt, PipeFlow& f) {
      f.pressure_pa[0] = kCharged - 1e3;
      tail.See(t, dt, f);
    });
    ExpectPublished("A: 1 kPa step at the tail, " + std::to_string(cells) + " cells [s]", tail.time(), expected, 0.01);
  }
}

// (B) A nozzle of 25 mm at the head.
TEST(PipeFlow, AVentAtTheHead) {
  const double conductance = NozzleConductance(0.025, 0.8, kTemperature);
  std::vector<double> first_times;
  for (int cells : {200, 400, 800}) {
    const PipeGrid grid = Grid(1000.0, 0.032, cells);
    PipeFlow flow(grid, kCharged);
    std::vector<FallTime> falls;
    for (double drop : {10e3, 50e3})
      for (double x : {250.0, 500.0, 1000.0}) falls.emplace_back(grid, x, drop);
    double left = MassOf(grid, flow), vented = 0.0;
    Simulate(grid, grid.LongestStep(), 20.0, flow, [&](double t, double dt, PipeFlow& f) {
      vented -= f.mass_flow_kgps[0] * dt;  // of the step that was made
      f.mass_flow_kgps[0] = -NozzleFlow(conductance, f.pressure_pa[0], kAtmospherePa);
      for (FallTime& fall : falls) fall.See(t, dt, f);
    });
    const double expected[] = {1.02, 2.75, 4.98, 2.97, 7.92, 11.49};
    for (int i = 0; i < 6; ++i) {
      ExpectPublished("B: vent, " + std::to_string(cells) + " cells, -" + (i < 3 ? "10" : "50") + " kPa at " +
                          std::to_string(i % 3 == 0 ? 250 : 500 * (i % 3)) + " m [s]",
                      falls[i].time(), expected[i], 0.02);
    }
    first_times.push_back(falls[3].time());
    ExpectPublished("B: tail at 20 s, " + std::to_string(cells) + " cells [kPa]", 1e-3 * flow.pressure_pa.back(), 489.7,
                    0.02);
    EXPECT_NEAR((MassOf(grid, flow) + vented) / left, 1.0, 1e-9);
  }
  // Of first order where the gradient is steepest, 250 m from the vent: halving the cells halves the change.
  EXPECT_NEAR((first_times[1] - first_times[0]) / (first_times[2] - first_times[1]), 2.0, 0.5);
}

// (C) The head falls by 100 kPa at 20 kPa/s; (D) the same with branches of 0.9 l per 13 m.
TEST(PipeFlow, AServiceReductionWithAndWithoutBranches) {
  for (bool branches : {false, true}) {
    for (int cells : {100, 200, 400}) {
      const PipeGrid grid = GridFromCentre(1000.0, 0.032, cells, branches ? 0.9e-3 / 13.0 : 0.0);
      PipeFlow flow(grid, kCharged);
      std::vector<FallTime> falls;
      for (double drop : {50e3, 90e3})
        for (double x : {500.0, 1000.0}) falls.emplace_back(grid, x, drop, 0.0);
      Simulate(grid, grid.LongestStep(), 40.0, flow, [&](double t, double dt, PipeFlow& f) {
        f.pressure_pa[0] = kCharged - std::min(100e3, 20e3 * t);
        for (FallTime& fall : falls) fall.See(t, dt, f);
      });
      const std::vector<double> expected =
          branches ? std::vector<double>{14.99, 17.48, 32.23, 33.47} : std::vector<double>{13.93, 16.24, 29.80, 30.94};
      for (int i = 0; i < 4; ++i) {
        ExpectPublished((branches ? "D: ramp, branches, " : "C: ramp, ") + std::to_string(cells) + " cells, -" +
                            (i < 2 ? "50" : "90") + " kPa at " + (i % 2 == 0 ? "500" : "1000") + " m [s]",
                        falls[i].time(), expected[i], 0.02);
      }
    }
  }
}

// (E) Steady flow of 10 g/s through the pipe, and as uniform leakage; f = 0.025.
TEST(PipeFlow, SteadyFlowAndLeakage) {
  const PipeGrid grid = GridFromCentre(1000.0, 0.032, 100, 0.0, PipeFriction(0.025));
  PipeFlow through(grid, kCharged), leaking(grid, kCharged);
  Simulate(grid, grid.LongestStep(), 400.0, through, [&](double, double dt, PipeFlow& f) {
    f.pressure_pa[0] = kCharged;
    AddMass(grid, 99, -0.010 * dt, f);
  });
  Simulate(grid, grid.LongestStep(), 400.0, leaking, [&](double, double dt, PipeFlow& f) {
    f.pressure_pa[0] = kCharged;
    for (int i = 0; i < 100; ++i) AddMass(grid, i, -0.0001 * dt, f);
  });
  ExpectPublished("E: 10 g/s through, head less tail [kPa]", 600.0 - 1e-3 * through.pressure_pa.back(), 600.0 - 591.469,
                  0.02);
  ExpectPublished("E: 10 g/s of leakage, head less tail [kPa]", 600.0 - 1e-3 * leaking.pressure_pa.back(),
                  600.0 - 597.170, 0.02);
}

// (F) 60 CFM leaking uniformly from 1829 m at 90 psig: gradient 53.9 kPa with f = 0.025, 87.3 kPa with the friction
// law.
TEST(PipeFlow, TheGradientOfALeakingTrain) {
  const double charged = 90.0 * 6894.76 + kAtmospherePa;
  for (bool law : {false, true}) {
    const PipeGrid grid = GridFromCentre(1829.0, 0.03175, 200, 0.0, law ? PipeFriction() : PipeFriction(0.025));
    PipeFlow flow(grid, charged);
    Simulate(grid, grid.LongestStep(), 900.0, flow, [&](double, double dt, PipeFlow& f) {
      f.pressure_pa[0] = charged;
      for (int i = 0; i < 200; ++i) AddMass(grid, i, -0.0341 / 200 * dt, f);
    });
    const double gradient = charged - flow.pressure_pa.back();
    ExpectPublished(law ? "F: gradient of 60 CFM, friction law [kPa]" : "F: gradient of 60 CFM, f = 0.025 [kPa]",
                    1e-3 * gradient, law ? 87.3 : 53.9, 0.02);
  }
}

TEST(PipeFlow, AClosedFaceIsAWall) {
  const PipeGrid grid = Grid(100.0, 0.032, 20);
  PipeFlow flow(grid, kCharged);
  flow.open[10] = 0.0;
  Simulate(grid, grid.LongestStep(), 5.0, flow, [&](double, double, PipeFlow& f) { f.pressure_pa[0] = 300e3; });
  for (int i = 10; i < 20; ++i) EXPECT_EQ(flow.pressure_pa[i], kCharged);
  EXPECT_NEAR(flow.pressure_pa[9], 300e3, 1e3);
}

// A hose that has parted lets both halves out through its full bore: they mirror each other.
TEST(PipeFlow, APartedHoseEmptiesBothSidesAlike) {
  const PipeGrid grid = Grid(400.0, 0.032, 100);
  PipeFlow flow(grid, kCharged);
  flow.open[50] = 0.0;
  const double bore = NozzleConductance(0.032, 0.8, kTemperature);
  const double before = MassOf(grid, flow);
  double vented = 0.0;
  Simulate(grid, grid.LongestStep(), 30.0, flow, [&](double, double dt, PipeFlow& f) {
    for (int cell : {49, 50})
      vented += PassToPlace(bore * grid.rt, dt, f.pressure_pa[cell], grid.volume_m3[cell], kAtmospherePa) / grid.rt;
    for (int i = 0; i < 50; ++i) ASSERT_NEAR(f.pressure_pa[i], f.pressure_pa[99 - i], 1e-6 * kCharged);
    for (double p : f.pressure_pa) ASSERT_GE(p, 0.98 * kAtmospherePa);
  });
  EXPECT_NEAR((MassOf(grid, flow) + vented) / before, 1.0, 1e-9);
  EXPECT_NEAR(flow.pressure_pa[0], kAtmospherePa, 20e3);
}

}  // namespace
}  // namespace train_dynamics
