#include "train_dynamics/vehicle/wagon_modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "paper_vehicle.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

// The paper's wagon as the analysis takes it: wedges without friction, wheels that roll without creep forces.
const Wagon& SmoothWagon() {
  static const Wagon wagon = [] {
    VehicleParams p = OreWagon();
    p.friction_wedge->static_friction_coefficient = p.friction_wedge->kinetic_friction_coefficient = 0.0;
    p.wheel_rail.adhesion.friction_coefficient = 1e-12;
    p.propulsion_resistance = {0.0, 0.0, 0.0};
    return Wagon(p);
  }();
  return wagon;
}

const WagonModes<>& Modes() {
  static const WagonModes<> modes = AnalyseModes(SmoothWagon());
  return modes;
}

TEST(WagonModes, CountsEveryFreedom) {
  // Five motions without a restoring force: travel and the rotation of four wheelsets. All others swing: 27
  // in all.
  EXPECT_EQ(Modes().rigid_body_modes, 5);
  EXPECT_EQ(Modes().modes.size(), 22u);
  double last = 0.0;
  for (const WagonMode<>& mode : Modes().modes) {
    EXPECT_GE(mode.frequency_hz, last);
    last = mode.frequency_hz;
    EXPECT_GT(mode.damping_ratio, 0.0);  // every mode is damped by a pad or a contact
    EXPECT_LT(mode.damping_ratio, 1.0);
    double share = 0.0;
    for (const auto* motion : {&mode.energy_share.x, &mode.energy_share.z, &mode.energy_share.pitch}) {
      share = std::accumulate(motion->begin(), motion->end(), share);
    }
    EXPECT_NEAR(share, 1.0, 1e-12);  // rounding
  }
}

TEST(WagonModes, BounceIsThatOfOneMassOnSpringsInSeries) {
  const double kappa = SmoothWagon().wedge.kappa;
  const double nests = 8.0 * (1590e3 + 566e3 + kappa * kappa * (983e3 + 566e3));
  const double series = 1.0 / (1.0 / nests + 1.0 / (8.0 * 3e7) + 1.0 / (8.0 * 6e8) + 1.0 / (2.0 * 4e8));
  const double bounce = std::sqrt(series / 147599.8) / (2.0 * std::acos(-1.0));
  const WagonMode<>& lowest = Modes().modes[0];
  EXPECT_GT(lowest.energy_share.z[kCarbody], 0.9);
  // Bolsters, frames and wheelsets move along: 5 % of the mass with at most a part of the motion.
  EXPECT_NEAR(lowest.frequency_hz, bounce, 0.01 * bounce);
  EXPECT_NEAR(lowest.frequency_hz, 2.04, 0.02);  // the project's notes
}

TEST(WagonModes, PitchIsThatOfACarbodyOnTwoBogies) {
  // The carbody turns by theta on the bogies' springs in series at +-a. The bolsters travel up and down with
  // it. They turn with it too, held down by its rims, on nests and wedges before and behind their centres.
  // And both bogies must follow lengthways, for the guides are 2.0 m - 0.55 m below the carbody's centre.
  const double a = 3.4825, arm = 2.0 - 0.55;
  const double kappa = SmoothWagon().wedge.kappa;
  const double nest = 1590e3 + 566e3, wedge = kappa * kappa * (983e3 + 566e3);
  const double bogie = 1.0 / (1.0 / (4.0 * (nest + wedge)) + 1.0 / (4.0 * 3e7) + 1.0 / (4.0 * 6e8) + 1.0 / 4e8);
  const double bolster_turning = 4.0 * (nest * 0.15 * 0.15 + wedge * 0.25 * 0.25);
  const double bolster_kg = 1103.9 + 4.0 * 6.0, carbody_kg = 147599.8;
  const double bogies_kg = 2.0 * (bolster_kg + 1665.5 + 2.0 * 1731.8);
  const double reduced_kg = bogies_kg * carbody_kg / (bogies_kg + carbody_kg);
  const double inertia = 1229545.83 + 2.0 * bolster_kg * a * a + reduced_kg * arm * arm;
  const double pitch_hz = std::sqrt(2.0 * (bogie * a * a + bolster_turning) / inertia) / (2.0 * std::acos(-1.0));
  const WagonMode<>& pitch = Modes().modes[1];
  EXPECT_GT(pitch.energy_share.pitch[kCarbody], 0.9);
  // Left out, each less than 0.1 %: the plates give 3 % of the travel, the frames take part in 11 % of it, the
  // bolsters turn 1 % less than the carbody. (Without the bolsters' travel or without the bogies' following the
  // closed form would be 1 % too high.)
  EXPECT_NEAR(pitch.frequency_hz, pitch_hz, 0.002 * pitch_hz);
}

// Largest vertical speed of a wagon, kicked at 1e-7 m/s, after 4000 steps.
double SpeedAfter(double dt) {
  WagonState<double> s = StaticEquilibrium(SmoothWagon(), 0.0, 0.0);
  for (int i = 0; i < kBodies; ++i) {
    s.velocity.z[i] = 1e-7 * (i % 3 - 1);
    s.velocity.x[i] = 1e-7 * (i % 2);
  }
  WagonOutput<double> output;
  for (int i = 0; i < 4000; ++i) StepWagon(SmoothWagon(), {}, VehicleLoads<double>(), dt, s, &output);
  double largest = 0.0;
  for (int i = 0; i < kBodies; ++i) largest = std::max({largest, std::abs(s.velocity.z[i]), std::abs(s.velocity.x[i])});
  return largest;
}

TEST(WagonModes, BeyondTheLargestStableStepTheWagonShakesItselfApart) {
  const double limit = Modes().largest_stable_step_s;
  EXPECT_GT(limit, 1.2e-3);  // the project's step of 1 ms keeps its distance
  EXPECT_LT(SpeedAfter(0.98 * limit), 1e-6);
  EXPECT_GT(SpeedAfter(1.02 * limit), 1e-2);
}

}  // namespace
}  // namespace train_dynamics
