#include "train_dynamics/vehicle/wheelset_slip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {
namespace {

constexpr double kDt = 1e-3;
constexpr double kAxleLoad = 392.6e3;  // [N]
constexpr double kRegularisation = 0.01;

const Wagon& PaperWagon() {
  static const Wagon wagon(OreWagon());
  return wagon;
}

AdhesionParams Rail(const std::string& name) { return LoadPart<AdhesionParams>("adhesion/" + name + ".yaml"); }

CreepLaw<double> LawOf(const AdhesionParams& adhesion, double normal, double speed) {
  return FreezeCreepLaw(adhesion, PaperWagon().creep_stiffness, normal, adhesion.friction_coefficient, speed,
                        kRegularisation);
}

double LockedCompliance() { return kDt * PaperWagon().rolling.inv_mass_per_kg; }
double TurningCompliance() {
  const RollingInertia& i = PaperWagon().rolling;
  return LockedCompliance() + kDt * i.radius_m * i.radius_m * i.inv_inertia_per_kgm2;
}

// Creep force at the slip speed with w + h F(w) = w0, by bisection: w + h F(w) grows with w because F falls,
// where it does, by less than 0.1 / h.
double ExactForce(const CreepLaw<double>& law, double h, double w0) {
  const double goal = std::abs(w0);
  double low = 0.0, high = goal;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (middle + h * PolachForce(law, middle).force < goal ? low : high) = middle;
  }
  return std::copysign(PolachForce(law, high).force, w0);
}

// From any guess: that of the step before, off by a little or by much, of the wrong sign, none, beyond all bounds.
TEST(SolveSlip, MeetsTheImplicitEquation) {
  for (const char* name : {"paper", "dry", "wet", "low", "very_low"}) {
    const AdhesionParams rail = Rail(name);
    for (const double normal : {1e3, 5e4, kAxleLoad, 8e5}) {
      for (const double h : {LockedCompliance(), TurningCompliance()}) {
        for (const double speed : {0.0, 0.02, 0.1, 0.5, 2.0, 5.0, 10.0, 22.2, 40.0}) {
          const CreepLaw<double> law = LawOf(rail, normal, speed);
          for (double w0 = 1e-7; w0 < 45.0; w0 *= 1.2) {
            const double exact = ExactForce(law, h, w0), slip = w0 - h * exact;
            for (const double guess : {0.0, slip, 0.9995 * slip, 1.03 * slip, 0.5 * slip, 2.0 * slip, -w0, 1e3}) {
              const SlipSolution<double> s = SolveSlip(law, h, w0, guess);
              const double error = (s.force - exact) / law.friction_limit;
              // Too much force, so that the error damps the slip; too little only where friction falls, by w^2 F'' 1e-6
              // / 2 at most, with x^2 e^-x <= 0.542.
              EXPECT_LT(error, 1e-6) << name << speed << " " << w0 << " " << guess;
              EXPECT_GT(error, -1e-9 - 0.271e-6 * (1.0 - rail.friction_ratio))
                  << name << speed << " " << w0 << " " << guess;
              EXPECT_LE(s.force,
                        law.friction_limit * (1.0 + 1e-12));  // 1e-12: s.force is a difference over h
              EXPECT_GE(s.slip, 0.0);
              // By construction, to the rounding of the difference w0 - w.
              EXPECT_NEAR(s.slip + h * s.force, w0, 1e-15 * w0);
            }
          }
        }
      }
    }
  }
}

// How long one wheelset takes to arrive changes nothing for those beside it.
TEST(SolveSlip, WheelsetsSideBySideAreSolvedAsAlone) {
  const CreepLaw<double> dry = LawOf(Rail("dry"), kAxleLoad, 3.0), low = LawOf(Rail("low"), 1e5, 12.0);
  for (const double w0 : {1e-4, 0.02, 0.3, 11.0}) {
    for (const double guess : {0.0, 1e-4, 0.02, 11.0}) {
      const std::array<SlipSolution<double>, 3> together =
          SolveSlip<double, 3>({dry, low, dry}, {TurningCompliance(), LockedCompliance(), TurningCompliance()},
                               {w0, 0.2, -w0}, {guess, 0.19, 0.0});
      EXPECT_EQ(together[0].force, SolveSlip(dry, TurningCompliance(), w0, guess).force);
      EXPECT_EQ(together[1].force, SolveSlip(low, LockedCompliance(), 0.2, 0.19).force);
      EXPECT_EQ(together[2].force, SolveSlip(dry, TurningCompliance(), -w0, 0.0).force);
    }
  }
}

TEST(SolveSlip, IsExactlyOddAndVanishesWithTheLoad) {
  const CreepLaw<double> law = LawOf(Rail("dry"), kAxleLoad, 3.0);
  for (double w0 = 1e-6; w0 < 30.0; w0 *= 2.0) {
    const SlipSolution<double> forward = SolveSlip(law, TurningCompliance(), w0, 1e-3);
    const SlipSolution<double> backward = SolveSlip(law, TurningCompliance(), -w0, -1e-3);
    EXPECT_EQ(backward.force, -forward.force);
    EXPECT_EQ(backward.slip, -forward.slip);
    const SlipSolution<double> free = SolveSlip(LawOf(Rail("dry"), 0.0, 3.0), TurningCompliance(), w0, 1e-3);
    EXPECT_EQ(free.force, 0.0);
    EXPECT_EQ(free.slip, w0);
  }
}

// The reason for all this. Explicit Euler on w' = -F(w) (1/m + r^2/J) multiplies a small slip by 1 - dt
// lambda, with dt lambda = 40 (m/s) / v: below 20 m/s any disturbance grows until the force jumps between the
// two friction limits.
TEST(SolveSlip, AnExplicitStepIsUnstableWhereThisOneIsNot) {
  for (const double speed : {16.7, 5.0, 1.0}) {
    const CreepLaw<double> law = LawOf(Rail("paper"), kAxleLoad, speed);
    const double pull = 0.05 * law.friction_limit;  // the steady creep force, as under a service brake
    const double h = TurningCompliance();
    double explicit_slip = 0.0, implicit_slip = 0.0, implicit_force = 0.0, largest_force = 0.0;
    for (int step = 0; step < 2000; ++step) {
      const double f = std::copysign(PolachForce(law, std::abs(explicit_slip)).force, explicit_slip);
      if (step > 1000) largest_force = std::max(largest_force, std::abs(f));
      explicit_slip += h * (pull - f);
      const SlipSolution<double> s = SolveSlip(law, h, implicit_slip + h * pull, implicit_slip);
      implicit_slip = s.slip;
      implicit_force = s.force;
    }
    EXPECT_GT(largest_force, 4.0 * pull) << speed;  // a false branch, not an error of some per cent
    EXPECT_NEAR(implicit_force, pull, 1e-9 * pull) << speed;
  }
}

// ---- rolling with brakes
// --------------------------------------------------------------------------------------------

struct Case {
  CreepLaw<double> law;
  RollingInput<double> in;
};

// Wheels of all loads at all speeds: rolling, slipping, locked, with and without brakes and traction.
std::vector<Case> RandomCases(int count, bool with_traction) {
  std::mt19937_64 random(3);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const std::vector<AdhesionParams> rails = {Rail("paper"), Rail("dry"), Rail("wet"), Rail("low"), Rail("very_low")};
  const double r = PaperWagon().rolling.radius_m;
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    const double speed = std::pow(10.0, uniform(-4.0, 1.6)) * (i % 2 == 0 ? 1.0 : -1.0);
    const double slip = i % 3 == 0 ? speed * uniform(0.0, 1.2) : speed * uniform(-1e-3, 1e-3);
    const double spin = i % 7 == 0 ? 0.0 : (speed - slip) / r;
    const double brake = i % 5 == 0 ? 0.0 : std::pow(10.0, uniform(0.0, 5.0));
    const double traction = with_traction ? uniform(-3e4, 3e4) : 0.0;
    const double normal = i % 11 == 0 ? 0.0 : std::pow(10.0, uniform(3.0, 5.9));
    cases.push_back(
        {LawOf(rails[i % rails.size()], normal, speed),
         {speed + uniform(-0.01, 0.01), spin, traction, brake, brake * (i % 4 < 2 ? 1.0 : 1.3), speed - r * spin}});
  }
  return cases;
}

TEST(StepRolling, BooksMomentumAndEnergyExactly) {
  const RollingInertia& inertia = PaperWagon().rolling;
  for (const Case& c : RandomCases(20000, true)) {
    const RollingResult<double> out = StepRolling(inertia, c.law, c.in, kDt);
    const double m = 1.0 / inertia.inv_mass_per_kg, j = 1.0 / inertia.inv_inertia_per_kgm2, r = inertia.radius_m;
    // Tolerances: rounding, a few ulp of the momenta involved.
    const double momentum = m * std::abs(c.in.speed);
    EXPECT_NEAR(m * out.speed, m * c.in.speed - kDt * out.creep_force,
                6e-16 * (momentum + kDt * std::abs(out.creep_force)));
    const double torque = c.in.traction_torque + r * out.creep_force - out.brake_torque;
    const double spin_scale =
        j * std::abs(c.in.spin) +
        kDt * (std::abs(c.in.traction_torque) + std::abs(out.brake_torque) + r * std::abs(out.creep_force));
    EXPECT_NEAR(j * out.spin, j * c.in.spin + kDt * torque, 1e-15 * spin_scale);
    // Hence energy: each force times the mean of the speeds before and after.
    const double gained = 0.5 * m * (out.speed * out.speed - c.in.speed * c.in.speed) +
                          0.5 * j * (out.spin * out.spin - c.in.spin * c.in.spin);
    const double moved = 0.5 * kDt * (c.in.speed + out.speed), turned = 0.5 * kDt * (c.in.spin + out.spin);
    const double work = -out.creep_force * (moved - r * turned) + (c.in.traction_torque - out.brake_torque) * turned;
    const double energy_scale = m * c.in.speed * c.in.speed + spin_scale * spin_scale / j;
    EXPECT_NEAR(gained, work, 1e-14 * energy_scale);
  }
}

// Torque that keeps the wheels from turning at the end of the step.
double HoldingTorque(const CreepLaw<double>& law, const RollingInput<double>& in) {
  const RollingInertia& i = PaperWagon().rolling;
  return in.spin / (i.inv_inertia_per_kgm2 * kDt) + in.traction_torque +
         i.radius_m * ExactForce(law, LockedCompliance(), in.speed);
}

// What the set-valued equations ask for, by nested bisection on the spin at the end of the step. Where both
// turning and standing would meet them, the wheels stand.
RollingResult<double> ExactRolling(const CreepLaw<double>& law, const RollingInput<double>& in) {
  const RollingInertia& i = PaperWagon().rolling;
  const double r = i.radius_m, j = 1.0 / i.inv_inertia_per_kgm2;
  const auto force = [&](double spin) { return ExactForce(law, LockedCompliance(), in.speed - r * spin); };
  const auto missing = [&](double spin) {  // torque against the rotation that this spin needs; falls with it
    return j * (in.spin - spin) / kDt + in.traction_torque + r * force(spin);
  };
  const double holding = HoldingTorque(law, in);
  double spin = 0.0;
  const double torque = std::clamp(holding, -in.brake_torque, in.brake_torque);
  if (std::abs(holding) > in.holding_torque) {
    const double reach = std::abs(in.spin) + std::abs(in.speed) / r + kDt / j * (1e5 + r * law.friction_limit);
    double low = holding > 0.0 ? 0.0 : -reach, high = holding > 0.0 ? reach : 0.0;
    for (int k = 0; k < 70; ++k) {
      const double middle = 0.5 * (low + high);
      (missing(middle) > torque ? low : high) = middle;
    }
    spin = 0.5 * (low + high);
  }
  const double f = force(spin);
  return {in.speed - LockedCompliance() * f, spin, f, spin == 0.0 ? holding : torque};
}

TEST(StepRolling, SolvesTheSetValuedEquations) {
  const double r = PaperWagon().rolling.radius_m;
  int locked = 0, turning = 0;
  for (const Case& c : RandomCases(2000, true)) {
    const RollingResult<double> out = StepRolling(PaperWagon().rolling, c.law, c.in, kDt);
    const RollingResult<double> exact = ExactRolling(c.law, c.in);
    const double tolerance = 1e-6 * c.law.friction_limit + 1e-6;  // that of SolveSlip, see above
    const double spare = c.in.holding_torque - std::abs(HoldingTorque(c.law, c.in));
    if (c.in.holding_torque > c.in.brake_torque && std::abs(spare) < r * tolerance) continue;  // on the edge
    EXPECT_NEAR(out.creep_force, exact.creep_force, tolerance);
    EXPECT_NEAR(out.brake_torque, exact.brake_torque, 2.0 * r * tolerance + 1e-9 * std::abs(exact.brake_torque));
    if (exact.spin == 0.0 && std::abs(exact.brake_torque) < c.in.holding_torque - r * tolerance) {
      EXPECT_EQ(out.spin, 0.0);
      ++locked;
    }
    if (exact.spin != 0.0 &&
        std::abs(exact.spin) > kDt * PaperWagon().rolling.inv_inertia_per_kgm2 * 2.0 * r * tolerance) {
      EXPECT_GT(out.spin * exact.spin, 0.0);
      ++turning;
    }
  }
  EXPECT_GT(locked, 100);  // the sample has both in plenty
  EXPECT_GT(turning, 100);
}

TEST(StepRolling, TheBrakeNeverDrivesTheWheel) {
  for (const bool with_traction : {false, true}) {
    for (const Case& c : RandomCases(50000, with_traction)) {
      const RollingResult<double> out = StepRolling(PaperWagon().rolling, c.law, c.in, kDt);
      EXPECT_LE(std::abs(out.brake_torque), c.in.holding_torque * (1.0 + 1e-15));
      if (out.spin != 0.0 && c.in.brake_torque > 0.0) {
        EXPECT_EQ(std::abs(out.brake_torque), c.in.brake_torque);  // full torque while turning
        EXPECT_GT(out.brake_torque * out.spin, 0.0)
            << "v " << c.in.speed << " spin " << c.in.spin << " -> " << out.spin << " brake " << c.in.brake_torque
            << " traction " << c.in.traction_torque << " limit " << c.law.friction_limit;
      }
      // A wheel that rolls forward under a forward-moving vehicle may stop, but not turn back.
      if (!with_traction && c.in.speed * c.in.spin >= 0.0) {
        EXPECT_GE(out.spin * c.in.speed, 0.0);
      }
    }
  }
}

TEST(StepRolling, IsTheSameInBothDirections) {
  for (const Case& c : RandomCases(5000, true)) {
    const RollingInput<double> mirrored{-c.in.speed,       -c.in.spin,          -c.in.traction_torque,
                                        c.in.brake_torque, c.in.holding_torque, -c.in.slip};
    const RollingResult<double> out = StepRolling(PaperWagon().rolling, c.law, c.in, kDt);
    const RollingResult<double> back = StepRolling(PaperWagon().rolling, c.law, mirrored, kDt);
    EXPECT_EQ(out.speed, -back.speed);
    EXPECT_EQ(out.spin, -back.spin);
    EXPECT_EQ(out.creep_force, -back.creep_force);
    EXPECT_EQ(out.brake_torque, -back.brake_torque);
  }
}

TEST(StepRolling, LocksStaysLockedAndTurnsAgain) {
  const RollingInertia& inertia = PaperWagon().rolling;
  const double r = inertia.radius_m;
  double v = 10.0, spin = 10.0 / r;
  const auto step = [&](const char* rail, double brake) {
    const RollingResult<double> out = StepRolling(inertia, LawOf(Rail(rail), kAxleLoad, v),
                                                  RollingInput<double>{v, spin, 0.0, brake, brake, v - r * spin}, kDt);
    spin = out.spin;  // the vehicle's mass keeps the speed
    return out;
  };
  const AdhesionParams low = Rail("low");
  const double brake = 2.0 * r * low.friction_coefficient * kAxleLoad;  // twice what the rail can turn the wheel with
  for (int i = 0; i < 2000; ++i) step("low", brake);
  EXPECT_EQ(spin, 0.0);  // exactly
  const RollingResult<double> sliding = step("low", brake);
  EXPECT_EQ(spin, 0.0);
  // The brake holds what the rail gives, not its own most: at a slip of v the friction has fallen to mu(v). Full
  // sliding to 1 %: kS eps is above 100 at this slip.
  EXPECT_NEAR(sliding.brake_torque, r * sliding.creep_force, 1e-9 * brake);
  const double fallen = low.friction_coefficient *
                        ((1.0 - low.friction_ratio) * std::exp(-low.friction_decay_s_per_m * v) + low.friction_ratio);
  EXPECT_NEAR(sliding.creep_force, fallen * kAxleLoad, 0.01 * fallen * kAxleLoad);
  for (int i = 0; i < 2000; ++i) step("paper", brake);
  EXPECT_NEAR(r * spin, v, 0.01 * v);  // good rail: rolls again, with the creepage of a braked wheel
}

TEST(StepRolling, WithoutBrakeAndSlipNothingHappens) {
  const double r = PaperWagon().rolling.radius_m;
  for (const double v : {-30.0, 0.0, 0.004, 17.0}) {
    const RollingInput<double> in{v, v / r, 0.0, 0.0, 0.0, 0.0};
    const RollingResult<double> out = StepRolling(PaperWagon().rolling, LawOf(Rail("dry"), kAxleLoad, v), in, kDt);
    // v - r (v / r) is zero or the last bit of v; the creep law makes at most 1e9 Ns/m x 4e-15 m/s of it.
    EXPECT_NEAR(out.creep_force, 0.0, 1e-5);
    EXPECT_NEAR(out.speed, v, 1e-14);
  }
}

}  // namespace
}  // namespace train_dynamics
