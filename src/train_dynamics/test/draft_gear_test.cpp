#include "train_dynamics/coupler/draft_gear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/coupler/connection.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

const DraftGearParams& PaperGear() {
  static const DraftGearParams gear = LoadPart<ConnectionParams>("couplers/calibrated.yaml").draft_gear;
  return gear;
}

// Extensions over the slack, the preload, the springs and the solid stop (from 0.171 m), on both sides.
std::vector<double> Extensions() {
  std::vector<double> q;
  for (double size = 0.0; size < 0.19; size += 0.00037) {
    q.push_back(size);
    q.push_back(-size);
  }
  return q;
}

const std::vector<double> kRates = {0.0, 1e-4, 0.01, 0.077, 0.3, 2.0};  // [m/s]

double Smooth(const DraftGearParams& p, double q, double rate) { return SmoothGearForce(DraftGear(p), q, rate).force; }

TEST(DraftGear, SmoothForceIsEq4) {
  const DraftGearParams& p = PaperGear();
  const double tan_phi = std::tan(22.0 * kPi / 180.0);
  for (const double q : Extensions()) {
    for (const double speed : kRates) {
      for (const double rate : {speed, -speed}) {
        const double d = 0.5 * std::max(std::abs(q) - 0.005, 0.0);
        const double w = (q < 0.0 ? -0.5 : 0.5) * rate;
        const double spring = 18800.0 * std::min(d / 0.001, 1.0) + 40e6 * d;
        const double mu = (0.05 + (0.33 - 0.05) * std::exp(-std::abs(w) / 0.278)) * std::tanh(w / 0.0384);
        const double size = spring * tan_phi / (tan_phi - mu) + 1e8 * std::max(d - 0.083, 0.0);
        // Decay, wrong by a share of 2e-12, makes mu wrong by (0.33 - 0.05) 2e-12 and tanh by 1e-12; the denominator
        // tan(phi) - mu is at least 0.074.
        EXPECT_NEAR(Smooth(p, q, rate), q < 0.0 ? -size : size, 1.3e-11 * size + 1e-9) << q << " " << rate;
      }
    }
  }
}

TEST(DraftGear, SlackCarriesNoForce) {
  const DraftGear gear(PaperGear());
  StickState<double> stick{0.0, 0.0};
  for (double q = -0.005; q <= 0.005; q += 1e-4) {
    EXPECT_EQ(SmoothGearForce(gear, q, 1.0).force, 0.0);
    EXPECT_EQ(StickSpringGearForce(gear, q, 1.0, stick).force, 0.0);
    EXPECT_EQ(GearEnergy(PaperGear(), q), 0.0);
  }
}

TEST(DraftGear, IsOdd) {
  const DraftGear gear(PaperGear());
  StickState<double> pulled{0.0, 0.0}, pushed{0.0, 0.0};
  double q_before = 0.0;
  for (double t = 0.0; t < 2.0; t += 1e-3) {
    const double q = 0.12 * std::sin(9.0 * t), rate = (q - q_before) / 1e-3;
    q_before = q;
    EXPECT_EQ(SmoothGearForce(gear, q, rate).force, -SmoothGearForce(gear, -q, -rate).force);
    EXPECT_EQ(StickSpringGearForce(gear, q, rate, pulled).force, -StickSpringGearForce(gear, -q, -rate, pushed).force);
    EXPECT_EQ(GearEnergy(gear.params, q), GearEnergy(gear.params, -q));
  }
}

TEST(DraftGear, SmoothForceIsContinuous) {
  const DraftGearParams& p = PaperGear();
  constexpr double kStep = 1e-9;
  // Slopes: over q at most (9.4 + 20 + 50) MN/m x 5.5, the largest friction factor; over q' at most dF/dmu /
  // (2 v_e), 7 MN x 5.5 x 5.5 / 0.4 x 0.33 / 0.077: 2.3e9 Ns/m.
  for (const double q : Extensions()) {
    for (const double rate : kRates) {
      EXPECT_NEAR(Smooth(p, q + kStep, rate), Smooth(p, q, rate), 4.4e8 * kStep);
      EXPECT_NEAR(Smooth(p, q, rate + kStep), Smooth(p, q, rate), 2.3e9 * kStep);
    }
  }
  for (const double q : {-0.1, 0.1}) {  // through the reversal of the motion
    EXPECT_NEAR(Smooth(p, q, kStep), Smooth(p, q, -kStep), 2.3e9 * 2.0 * kStep);
  }
}

TEST(DraftGear, LoadingIsStifferThanTheSpringAndUnloadingSofter) {
  const DraftGear gear(PaperGear());
  for (const double q : Extensions()) {
    if (std::abs(q) <= 0.0051) continue;
    for (const double speed : kRates) {
      if (speed == 0.0) continue;
      const double outward = q > 0.0 ? speed : -speed;
      const double elastic = std::abs(SmoothGearForce(gear, q, 0.0).elastic);
      EXPECT_DOUBLE_EQ(std::abs(SmoothGearForce(gear, q, 0.0).force), elastic);  // at rest: the spring
      EXPECT_GT(std::abs(SmoothGearForce(gear, q, outward).force), elastic);
      EXPECT_LT(std::abs(SmoothGearForce(gear, q, -outward).force), elastic);
      EXPECT_GT(std::abs(SmoothGearForce(gear, q, -outward).force), 0.0);  // never pulls back
    }
  }
}

TEST(DraftGear, ElasticForceIsTheSlopeOfTheEnergy) {
  const DraftGear gear(PaperGear());
  for (const double q : Extensions()) {
    const double h = 1e-6;
    const double slope = (GearEnergy(gear.params, q + h) - GearEnergy(gear.params, q - h)) / (2.0 * h);
    // Energy is quadratic between kinks, where the difference is exact but for rounding, 1e-16 x 1e5 J / 1e-6
    // m; a kink within the step costs h / 4 times its change of stiffness, 50 MN/m at most.
    EXPECT_NEAR(slope, SmoothGearForce(gear, q, 0.0).elastic, 13.0) << q;
  }
}

TEST(DraftGear, SolidStopActsBesideTheFriction) {
  const DraftGearParams& p = PaperGear();
  DraftGearParams without = p;
  without.travel_m = 1.0;
  for (const double rate : {-0.5, 0.0, 0.5}) {
    const double q = 0.5 * p.slack_m + 2.0 * (p.travel_m + 0.002);  // each gear 2 mm into its stop of 1e8 N/m
    EXPECT_NEAR(Smooth(p, q, rate) - Smooth(without, q, rate), 2e5, 1e-6);
  }
}

// Work done on a connection over one cycle of q = middle + amplitude sin(2 pi f t), by the trapezoidal rule
// after a cycle that forgets the start.
double CycleWork(const DraftGearParams& p, double middle, double amplitude, double frequency) {
  const DraftGear gear(p);
  StickState<double> stick{middle, 0.0};
  constexpr int kSteps = 20000;
  double work = 0.0, q_before = middle, force_before = 0.0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double phase = 2.0 * kPi * i / kSteps;
    const double q = middle + amplitude * std::sin(phase);
    const double rate = amplitude * 2.0 * kPi * frequency * std::cos(phase);
    const double force = p.friction == DraftGearFriction::kSmooth ? SmoothGearForce(gear, q, rate).force
                                                                  : StickSpringGearForce(gear, q, rate, stick).force;
    if (i > 0) work += 0.5 * (force + force_before) * (q - q_before);
    q_before = q;
    force_before = force;
  }
  return work;
}

TEST(DraftGear, EveryCycleTakesEnergy) {
  DraftGearParams p = PaperGear();
  for (const DraftGearFriction friction : {DraftGearFriction::kSmooth, DraftGearFriction::kStickSpring}) {
    p.friction = friction;
    for (const double middle : {0.0, 0.05, -0.1}) {
      for (const double amplitude : {0.003, 0.02, 0.09, 0.19}) {
        for (const double frequency : {0.01, 0.3, 5.0}) {
          const double work = CycleWork(p, middle, amplitude, frequency);
          if (std::abs(middle) + amplitude <= 0.5 * p.slack_m) {
            EXPECT_EQ(work, 0.0);
          } else {
            // A small cycle may stay within the stick spring, which is elastic: rounding of 6 MN x 6 mm then.
            const bool may_stick = friction == DraftGearFriction::kStickSpring && amplitude < 0.01;
            EXPECT_GT(work, may_stick ? -1e-8 : 0.0) << middle << " " << amplitude << " " << frequency;
          }
        }
      }
    }
  }
}

TEST(DraftGear, SmoothFrictionTakesEnergyAtEveryMoment) {
  const DraftGear gear(PaperGear());
  for (const double q : Extensions()) {
    for (const double rate : kRates) {
      for (const double q_rate : {rate, -rate}) {
        const GearForce<double> f = SmoothGearForce(gear, q, q_rate);
        EXPECT_GE((f.force - f.elastic) * q_rate, 0.0);
      }
    }
  }
}

TEST(DraftGear, WithoutFrictionACycleIsFree) {
  DraftGearParams p = PaperGear();
  p.static_friction_coefficient = p.kinetic_friction_coefficient = 0.0;
  for (const DraftGearFriction friction : {DraftGearFriction::kSmooth, DraftGearFriction::kStickSpring}) {
    p.friction = friction;
    // Trapezoidal rule over 20000 steps of a force with kinks: 1e-6 of the energy that goes to and fro (4e5
    // J).
    EXPECT_NEAR(CycleWork(p, 0.0, 0.19, 1.0), 0.0, 0.4);
  }
}

TEST(DraftGear, StickSpringStaysBetweenItsBranchesAndSticks) {
  DraftGearParams p = PaperGear();
  const DraftGear gear(p);
  StickState<double> stick{0.0, 0.0};
  const double loaded = StickSpringGearForce(gear, 0.08, 1.0, stick).force;
  const double elastic = StickSpringGearForce(gear, 0.08, 0.0, stick).elastic;
  EXPECT_GT(loaded, elastic);
  // Standing still, it holds its force: a smooth gear would fall back to the spring.
  EXPECT_EQ(StickSpringGearForce(gear, 0.08, 0.0, stick).force, loaded);
  // Pulled back by a hair it unloads along the stick stiffness, to the rounding of q - q_before.
  EXPECT_NEAR(StickSpringGearForce(gear, 0.08 - 1e-5, -1e-3, stick).force, loaded - 1e-5 * p.stick_stiffness_n_per_m,
              1e-6);
  // Pulled back further it is on the unloading branch.
  const double tan_phi = std::tan(22.0 * kPi / 180.0);
  const double mu = 0.05 + (0.33 - 0.05) * std::exp(-0.5 * 1e-3 / 0.278);
  const GearForce<double> back = StickSpringGearForce(gear, 0.06, -1e-3, stick);
  EXPECT_NEAR(back.force, back.elastic * tan_phi / (tan_phi + mu), 1e-9 * back.elastic);
}

TEST(DraftGear, StickSpringWithConstantFrictionDoesNotKnowTheSpeed) {
  DraftGearParams p = PaperGear();
  p.static_friction_coefficient = p.kinetic_friction_coefficient = 0.25;
  const DraftGear gear(p);
  StickState<double> slow{0.0, 0.0}, fast{0.0, 0.0};
  for (int i = 0; i < 5000; ++i) {
    const double q = 0.1 * std::sin(0.01 * i) + 0.04 * std::sin(0.037 * i);
    const double change = 0.1 * std::cos(0.01 * i) + 0.04 * std::cos(0.037 * i);
    EXPECT_EQ(StickSpringGearForce(gear, q, 1e-6 * change, slow).force,
              StickSpringGearForce(gear, q, 3.0 * change, fast).force);
  }
}

TEST(DraftGear, AWedgeThatLocksItselfIsRefused) {
  DraftGearParams p = PaperGear();
  EXPECT_NO_THROW(strict_config::Validate(p));
  p.static_friction_coefficient = 0.41;  // tan 22 deg = 0.404
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
  p = PaperGear();
  p.kinetic_friction_coefficient = 0.34;  // above the static one
  EXPECT_THROW(strict_config::Validate(p), std::invalid_argument);
}

}  // namespace
}  // namespace train_dynamics
