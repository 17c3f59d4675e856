#include "train_dynamics/contact/polach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "paper_vehicle.h"
#include "train_dynamics/contact/hertz.h"
#include "train_dynamics/contact/kalker.h"

namespace train_dynamics {
namespace {

const double kPi = std::acos(-1.0);

constexpr double kRegularisation = 0.01;  // v0 [m/s]

struct Rail {
  const char* name;
  AdhesionParams adhesion;
};

std::vector<Rail> NamedRails() {
  std::vector<Rail> rails;
  for (const char* name : {"paper", "dry", "wet", "damp", "low", "very_low"}) {
    rails.push_back({name, LoadPart<AdhesionParams>(std::string("adhesion/") + name + ".yaml")});
  }
  return rails;
}

// Semi-axes and c11 of the paper's wheel, by the laws tested above.
struct WheelContact {
  ContactEllipse ellipse;
  double c11, shear_modulus;
};

WheelContact PaperContact() {
  const VehicleParams& p = OreWagon();
  const ContactEllipse e = HertzEllipse(p.wheel_rail.hertz, p.wheelset.wheel_radius_m);
  return {e, KalkerC11(e.a_per_cbrt_n / e.b_per_cbrt_n, p.wheel_rail.hertz.poisson_ratio),
          p.wheel_rail.shear_modulus_pa};
}

CreepLaw<double> LawOf(const AdhesionParams& adhesion, double normal, double speed) {
  const WheelContact w = PaperContact();
  return FreezeCreepLaw(adhesion, CreepStiffness(w.ellipse, w.shear_modulus, w.c11), normal,
                        adhesion.friction_coefficient, speed, kRegularisation);
}

// Polach's published formula for each of two wheels, with the C library's functions.
double PublishedForce(const AdhesionParams& p, double normal, double speed, double slip_speed) {
  const WheelContact w = PaperContact();
  const double q = 0.5 * normal;
  const double a = w.ellipse.a_per_cbrt_n * std::cbrt(q), b = w.ellipse.b_per_cbrt_n * std::cbrt(q);
  const double mu = p.friction_coefficient *
                    ((1.0 - p.friction_ratio) * std::exp(-p.friction_decay_s_per_m * slip_speed) + p.friction_ratio);
  const double creepage = slip_speed / std::sqrt(speed * speed + kRegularisation * kRegularisation);
  const double eps = w.shear_modulus * kPi * a * b * w.c11 * creepage / (4.0 * q * mu);
  const double adhesion = p.adhesion_reduction * eps / (1.0 + std::pow(p.adhesion_reduction * eps, 2));
  return 2.0 * (2.0 * q * mu / kPi) * (adhesion + std::atan(p.slip_reduction * eps));
}

TEST(Polach, AgreesWithThePublishedFormula) {
  for (const Rail& rail : NamedRails()) {
    for (const double normal : {1e3, 392.6e3, 8e5}) {
      for (const double speed : {0.0, 0.5, 22.0, 40.0}) {
        const CreepLaw<double> law = LawOf(rail.adhesion, normal, speed);
        for (double slip = 1e-7; slip < 20.0; slip *= 3.0) {
          const double published = PublishedForce(rail.adhesion, normal, speed, slip);
          // Rounding of some twenty operations and of the elementary functions (elementary_test).
          EXPECT_NEAR(PolachForce(law, slip).force, published, 1e-13 * published) << rail.name;
        }
      }
    }
  }
}

TEST(Polach, SmallSlipSlopeIsKalkersLinearTheory) {
  const WheelContact w = PaperContact();
  for (const Rail& rail : NamedRails()) {
    const AdhesionParams& p = rail.adhesion;
    for (const double normal : {5e4, 392.6e3}) {
      for (const double speed : {1.0, -22.0}) {
        const double a = w.ellipse.a_per_cbrt_n * std::cbrt(0.5 * normal);
        const double b = w.ellipse.b_per_cbrt_n * std::cbrt(0.5 * normal);
        const double linear = (p.adhesion_reduction + p.slip_reduction) * w.shear_modulus * a * b * w.c11 /
                              std::sqrt(speed * speed + kRegularisation * kRegularisation);
        const CreepLaw<double> law = LawOf(p, normal, speed);
        EXPECT_NEAR(PolachForce(law, 0.0).slope, linear, 1e-13 * linear) << rail.name;  // rounding
        // The force leaves the line with the slip, relatively by about eps^2 and B w: 1e-9 here.
        const double slip = 1e-5 / law.steepness;
        EXPECT_NEAR(PolachForce(law, slip).force, linear * slip, 1e-6 * linear * slip) << rail.name;
      }
    }
  }
}

TEST(Polach, ForceOpposesSlipAndStaysWithinFriction) {
  for (const Rail& rail : NamedRails()) {
    const AdhesionParams& p = rail.adhesion;
    const CreepLaw<double> law = LawOf(p, 392.6e3, 10.0);
    EXPECT_EQ(PolachForce(law, 0.0).force, 0.0);
    for (double slip = 1e-9; slip < 1e3; slip *= 1.5) {
      const double friction =
          p.friction_coefficient *
          ((1.0 - p.friction_ratio) * std::exp(-p.friction_decay_s_per_m * slip) + p.friction_ratio);
      EXPECT_GT(PolachForce(law, slip).force, 0.0);
      EXPECT_LE(PolachForce(law, slip).force, 392.6e3 * friction * (1.0 + 1e-14)) << rail.name;  // rounding
    }
    // Full sliding: atan(x) = pi/2 - 1/x, so that 1e-5 of the friction is missing at kS eps = 1e5.
    const double far = 1e5 / (p.slip_reduction * law.steepness);
    const double sliding = 392.6e3 * p.friction_coefficient *
                           ((1.0 - p.friction_ratio) * std::exp(-p.friction_decay_s_per_m * far) + p.friction_ratio);
    EXPECT_NEAR(PolachForce(law, far).force, sliding, 1e-5 * sliding) << rail.name;
  }
}

TEST(Polach, AnalyticSlopeIsTheDerivative) {
  for (const Rail& rail : NamedRails()) {
    for (const double speed : {0.2, 22.0}) {
      const CreepLaw<double> law = LawOf(rail.adhesion, 392.6e3, speed);
      for (double slip = 1e-4; slip < 10.0; slip *= 1.7) {
        const double h = 1e-5 * slip;
        const double difference = (PolachForce(law, slip + h).force - PolachForce(law, slip - h).force) / (2.0 * h);
        // Error of a central difference: 1e-10 of F/w by its third derivative, 1e-11 by rounding.
        EXPECT_NEAR(PolachForce(law, slip).slope, difference, 1e-9 * PolachForce(law, slip).force / slip) << rail.name;
      }
    }
  }
}

TEST(Polach, NoLoadNoForce) {
  for (const Rail& rail : NamedRails()) {
    const CreepLaw<double> unloaded = LawOf(rail.adhesion, 0.0, 20.0);
    for (const double slip : {0.0, 1e-6, 1.0, 100.0}) {
      EXPECT_EQ(PolachForce(unloaded, slip).force, 0.0);
      EXPECT_EQ(PolachForce(unloaded, slip).slope, 0.0);
    }
    // A trace of load is a trace of force, not more.
    EXPECT_LE(PolachForce(LawOf(rail.adhesion, 1e-3, 20.0), 1.0).force, 1e-3);
  }
}

// F/Q over creep, from an independent program. It interpolates Kalker's table linearly along a/b (c11 about 5.71; ours
// 5.70), and at small creep the force is proportional to c11: hence 0.2 %.
TEST(Polach, ReferenceValuesOfDryAndWet) {
  const double creepage[] = {0.001, 0.01, 0.05, 0.2, 1.0};
  const struct {
    const char* name;
    double force_ratio[5];
  } surfaces[] = {{"dry", {0.07573, 0.33693, 0.36641, 0.24649, 0.21947}},
                  {"wet", {0.02190, 0.14612, 0.20678, 0.19104, 0.12255}}};
  constexpr double kLoad = 2.0 * 196.3e3, kSpeed = 20.0;
  for (const auto& surface : surfaces) {
    const auto adhesion = LoadPart<AdhesionParams>(std::string("adhesion/") + surface.name + ".yaml");
    const CreepLaw<double> law = LawOf(adhesion, kLoad, kSpeed);
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(PolachForce(law, creepage[i] * kSpeed).force / kLoad, surface.force_ratio[i],
                  2e-3 * surface.force_ratio[i])
          << surface.name << " at " << creepage[i];
    }
  }
}

TEST(Polach, ReferencePeaksOfDryAndWet) {
  const struct {
    const char* name;
    double speed, force_ratio, creepage;
  } peaks[] = {{"dry", 5.0, 0.45156, 0.061},
               {"dry", 20.0, 0.38121, 0.030},
               {"wet", 5.0, 0.25087, 0.164},
               {"wet", 20.0, 0.21428, 0.083}};
  constexpr double kLoad = 2.0 * 196.3e3;
  for (const auto& peak : peaks) {
    const auto adhesion = LoadPart<AdhesionParams>(std::string("adhesion/") + peak.name + ".yaml");
    const CreepLaw<double> law = LawOf(adhesion, kLoad, peak.speed);
    double largest = 0.0, at = 0.0;
    for (double creepage = 1e-3; creepage < 1.0; creepage += 1e-4) {
      const double force = PolachForce(law, creepage * peak.speed).force / kLoad;
      if (force > largest) largest = force, at = creepage;
    }
    EXPECT_NEAR(largest, peak.force_ratio, 1e-3 * peak.force_ratio) << peak.name;
    EXPECT_NEAR(at, peak.creepage, 0.001) << peak.name;  // printed with one decimal of a per cent, and flat
  }
}

// The creepage at which 90 % of mu N act on a surface whose friction does not fall: of the closed form
// (2/pi) (x/(1+x^2) + atan(kS/kA x)) with x = kA eps, solved here by halving.
TEST(Polach, SaturatesAtTheCreepageOfTheClosedForm) {
  const WheelContact w = PaperContact();
  const struct { double ka, ks, creepage; } surfaces[] = {{1.0, 1.0, 0.0008}, {0.3, 0.1, 0.024}};
  for (const auto& s : surfaces) {
    const double q = 196.3e3, mu = 0.05, speed = 20.0;
    double low = 0.0, high = 1e4;
    for (int i = 0; i < 100; ++i) {
      const double eps = 0.5 * (low + high), x = s.ka * eps;
      (2.0 / kPi * (x / (1.0 + x * x) + std::atan(s.ks * eps)) < 0.9 ? low : high) = eps;
    }
    const double a = w.ellipse.a_per_cbrt_n * std::cbrt(q), b = w.ellipse.b_per_cbrt_n * std::cbrt(q);
    const double creepage = low * 4.0 * q * mu / (w.shear_modulus * kPi * a * b * w.c11);
    EXPECT_NEAR(creepage, s.creepage, 0.05 * s.creepage);  // the reference has one or two digits
    AdhesionParams leaves;
    leaves.friction_coefficient = mu;
    leaves.adhesion_reduction = s.ka;
    leaves.slip_reduction = s.ks;
    const CreepLaw<double> law = LawOf(leaves, 2.0 * q, speed);
    EXPECT_NEAR(PolachForce(law, creepage * speed).force, 0.9 * 2.0 * q * mu, 1e-6 * 2.0 * q * mu);
  }
}

// A rigid vehicle that stops from 80 km/h by adhesion alone: s = int v dv / (g F/N). Bounds for any controller.
TEST(Polach, ShortestAndLockedStops) {
  const struct {
    const char* name;
    double at_peak_m, locked_m;
  } surfaces[] = {{"dry", 62.8, 113.2}, {"wet", 112.1, 188.6}};
  constexpr double kLoad = 2.0 * 196.3e3, kSteps = 2000;
  for (const auto& surface : surfaces) {
    const auto adhesion = LoadPart<AdhesionParams>(std::string("adhesion/") + surface.name + ".yaml");
    double at_peak = 0.0, locked = 0.0;
    const double dv = 80.0 / 3.6 / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double v = (i + 0.5) * dv;
      const CreepLaw<double> law = LawOf(adhesion, kLoad, v);
      double peak = 0.0;
      for (double creepage = 1e-3; creepage <= 1.0; creepage *= 1.01) {
        peak = std::max(peak, PolachForce(law, creepage * v).force);
      }
      at_peak += v * dv / (9.81 * peak / kLoad);
      locked += v * dv / (9.81 * PolachForce(law, v).force / kLoad);
    }
    EXPECT_NEAR(at_peak, surface.at_peak_m, 0.005 * surface.at_peak_m) << surface.name;
    EXPECT_NEAR(locked, surface.locked_m, 0.005 * surface.locked_m) << surface.name;
  }
}

}  // namespace
}  // namespace train_dynamics
