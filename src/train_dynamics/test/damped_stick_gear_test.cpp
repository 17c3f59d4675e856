// The default draft gear of real trains, held against closed forms.

#include "train_dynamics/coupler/damped_stick_gear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gear_cycles.h"
#include "paper_vehicle.h"
#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

DraftGearParams Gear(const std::string& name = "friction_gear") {
  return LoadPart<ConnectionParams>("couplers/" + name + ".yaml").draft_gear;
}

constexpr double kHalfSlack = 0.005;
const double kTan = std::tan(22.0 * M_PI / 180.0);
const double kLoading = kTan / (kTan - 0.28), kUnloading = kTan / (kTan + 0.28);  // 3.2575, 0.59066

/// Extension at which each gear has a travel.
double ExtensionAt(double travel_m) { return kHalfSlack + 2.0 * travel_m; }

/// Energy of one spring without stop [J], for travels beyond the preload's 1 mm.
double SpringEnergy(const DraftGearParams& p, double d) {
  return p.preload_n * (d - 0.5e-3) + 0.5 * p.spring_stiffness_n_per_m * d * d;
}

TEST(DampedStickGears, ASlowCycleTakesItsClosedFormShareAtAnyPeriod) {
  for (const double stick : {1e8, 1e9}) {
    DraftGearParams p = Gear();
    p.gear_stick_stiffness_n_per_m = stick;
    p.gear_stick_damping_ns_per_m = 0.0;
    const DampedStickGears gears(p);
    const double a = 0.015;
    const double f_loaded = kLoading * (p.preload_n + p.spring_stiffness_n_per_m * a);
    const double turn =
        (stick * a - f_loaded + kUnloading * p.preload_n) / (stick - kUnloading * p.spring_stiffness_n_per_m);
    const double f_turn = kUnloading * (p.preload_n + p.spring_stiffness_n_per_m * turn);
    const double in = kLoading * SpringEnergy(p, a);
    const double back = (f_loaded * f_loaded - f_turn * f_turn) / (2.0 * stick) + kUnloading * SpringEnergy(p, turn);
    for (const double rate : {1e-6, 1e-3, 1.0}) {
      std::vector<double> path = {kHalfSlack};
      MoveTo(path, ExtensionAt(a), 30000);
      const double work_in = 0.5 * WorkAlong(gears, path, rate);  // of one gear
      MoveTo(path, kHalfSlack, 30000);
      const double work = 0.5 * WorkAlong(gears, path, rate);
      EXPECT_NEAR(work_in, in, 1e-3 * in);  // steps of 1 um through the preload
      EXPECT_NEAR(work_in - work, back, 2e-3 * in);
      // The numbers of an independent program: 3876.5 J; shares 0.6300 and 0.8006.
      EXPECT_NEAR(work_in, 3876.5, 4.0);
      EXPECT_NEAR(work / work_in, stick == 1e8 ? 0.6300 : 0.8006, 1e-3);
    }
  }
}

TEST(DampedStickGears, AbsorbsUpToOneLessTheRatioOfItsBranches) {
  DraftGearParams p = Gear();
  p.gear_stick_stiffness_n_per_m = 1e12;
  const DampedStickGears gears(p);
  std::vector<double> path = {kHalfSlack};
  MoveTo(path, ExtensionAt(0.015), 20000);
  const double in = WorkAlong(gears, path);
  MoveTo(path, kHalfSlack, 20000);
  EXPECT_NEAR(WorkAlong(gears, path) / in, 1.0 - kUnloading / kLoading, 1e-3);  // 0.8187
}

TEST(DampedStickGears, ReachTheForceAndEnergyOfTheirSheets) {
  struct Sheet {
    const char* name;
    double travel_m, force_n, energy_j;
  };
  for (const Sheet& sheet : {Sheet{"friction_gear", 0.083, 2.228e6, 95.1e3}, Sheet{"mt2", 0.083, 2.20e6, 55e3},
                             Sheet{"tf880", 0.0744, 2.52e6, 61.7e3}}) {
    const DampedStickGears gears(Gear(sheet.name));
    std::vector<double> path = {kHalfSlack};
    MoveTo(path, ExtensionAt(sheet.travel_m), 50000);
    StickState<double> memory = gears.AtRest(kHalfSlack);
    for (const double q : path) ConnectionForce(gears, q, 0.0, memory);
    EXPECT_NEAR(memory.force, sheet.force_n, 5e-3 * sheet.force_n) << sheet.name;  // three digits are given
    EXPECT_NEAR(0.5 * WorkAlong(gears, path), sheet.energy_j, 5e-3 * sheet.energy_j) << sheet.name;
  }
}

TEST(DampedStickGears, AnImpactMeetsTheBalanceOfEnergyWhateverTheStickSpring) {
  constexpr double kMass = 171.66e3;
  struct Case {
    double speed_kmh, peak_n, travel_m;
  };
  // Peaks of an independent program, from 2 * 3.2575 U_s(d) = m v^2 / 4.
  for (const Case& c : {Case{3.0, 884.7e3, 0.03145}, Case{5.0, 1470.8e3, 0.05394}, Case{7.0, 2057.8e3, 0.07646}}) {
    for (const double stick : {2e8, 1e9}) {
      DraftGearParams p = Gear();
      p.gear_stick_stiffness_n_per_m = stick;
      const Impact impact = Collide(DampedStickGears(p), kMass, c.speed_kmh / 3.6, -kHalfSlack, 1e-5);
      EXPECT_NEAR(impact.peak_n, c.peak_n, 2e-3 * c.peak_n);
      EXPECT_NEAR(0.5 * impact.travel_m, c.travel_m, 2e-3 * c.travel_m);
      EXPECT_GT(impact.speed_mps, 0.0);
      EXPECT_LT(impact.speed_mps, 0.65 * c.speed_kmh / 3.6);
    }
  }
}

TEST(DampedStickGears, PartAsFastAsTheStoredEnergyAllows) {
  constexpr double kMass = 171.66e3, kSpeed = 5.0 / 3.6;
  DraftGearParams p = Gear();
  p.gear_stick_damping_ns_per_m = 0.0;
  const DampedStickGears gears(p);
  const Impact impact = Collide(gears, kMass, kSpeed, -kHalfSlack, 1e-5);
  const double q = -kHalfSlack - impact.travel_m;
  const StickState<double> turned = {q, -kLoading * (p.preload_n + p.spring_stiffness_n_per_m * 0.5 * impact.travel_m)};
  EXPECT_NEAR(0.25 * kMass * impact.speed_mps * impact.speed_mps, StoredEnergy(gears, q, turned),
              0.01 * StoredEnergy(gears, q, turned));
}

TEST(DampedStickGears, HoldUnderVibration) {
  const DampedStickGears gears(Gear());
  const double q = ExtensionAt(0.010);
  StickState<double> memory = gears.AtRest(kHalfSlack);
  for (int i = 0; i <= 10000; ++i) ConnectionForce(gears, kHalfSlack + (q - kHalfSlack) * i / 10000, 0.0, memory);
  const double held_n = memory.force;
  EXPECT_NEAR(held_n, 325.8e3, 0.1e3);
  constexpr double kAmplitude = 1e-6;  // of one gear
  double after_first_n = 0.0;
  for (int step = 0; step <= 40 * 1000; ++step) {  // 2 Hz for 20 s, in steps of half a millisecond
    ConnectionForce(gears, q + 2.0 * kAmplitude * std::sin(2.0 * M_PI * step / 1000.0), 0.0, memory);
    if (step % 1000 != 0 || step == 0) continue;
    if (step == 1000) after_first_n = memory.force;
    EXPECT_NEAR(memory.force, after_first_n, 1.0) << step;  // no creep
  }
  EXPECT_LE(held_n - after_first_n, 1e9 * kAmplitude + 1.0);
  EXPECT_GT(after_first_n, 0.99 * held_n);
}

TEST(DampedStickGears, DissipateAtEveryStepOfASlowPath) {
  DraftGearParams p = Gear();
  const DampedStickGears gears(p);
  std::mt19937_64 random(3);
  const std::vector<double> path = RandomPath(random, 0.12, 40, 4000);
  StickState<double> memory = gears.AtRest(0.0);
  double stored = StoredEnergy(gears, 0.0, memory), last_n = 0.0, total = 0.0, most_negative = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double force_n = ConnectionForce(gears, path[i], 0.0, memory).force;
    const double now = StoredEnergy(gears, path[i], memory);
    const double dissipated = 0.5 * (force_n + last_n) * (path[i] - path[i - 1]) - (now - stored);
    most_negative = std::min(most_negative, dissipated);
    total += dissipated;
    stored = now;
    last_n = force_n;
  }
  EXPECT_NEAR(stored, 0.0, 1e-9);
  EXPECT_GT(total, 0.0);
  EXPECT_GT(most_negative, -1e-5 * total);  // a trapezoid over the corner where the gear begins to slide
}

TEST(DampedStickGears, RefuseAFrictionThatFallsAndASoftStickSpring) {
  DraftGearParams p = Gear();
  p.kinetic_friction_coefficient = 0.2;
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
  p = Gear();
  p.gear_stick_stiffness_n_per_m = 9e7;  // 3.2575 (20 kN / 1 mm + 8 MN/m) = 91.2 MN/m
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
  p.gear_stick_stiffness_n_per_m = 9.2e7;
  EXPECT_NO_THROW(strict_config::Validate(p));
}

}  // namespace
}  // namespace train_dynamics
