#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "paper_vehicle.h"
#include "train_dynamics/vehicle/wagon.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

const Wagon& PaperWagon() {
  static const Wagon wagon(OreWagon());
  return wagon;
}

class RandomNumbers {
 public:
  double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  BodyVector<double> Bodies(double size) {
    BodyVector<double> v;
    for (int i = 0; i < kBodies; ++i) {
      v.x[i] = (*this)(-size, size);
      v.z[i] = (*this)(-size, size);
      v.pitch[i] = (*this)(-size, size);
    }
    return v;
  }

 private:
  std::mt19937_64 engine_{17};
};

// The numbers of all elements in one row, and those of all bodies.
Eigen::VectorXd Row(const ElementVector<double>& e) {
  Eigen::VectorXd row(24);
  for (int i = 0; i < 4; ++i) row.segment<5>(5 * i) << e.pad_x[i], e.pad_z[i], e.nest[i], e.wedge[i], e.rim[i];
  row.tail<4>() << e.guide_x[0], e.guide_x[1], e.plate_x[0], e.plate_x[1];
  return row;
}
Eigen::VectorXd Row(const BodyVector<double>& b) {
  Eigen::VectorXd row(3 * kBodies);
  for (int i = 0; i < kBodies; ++i) row.segment<3>(3 * i) << b.x[i], b.z[i], b.pitch[i];
  return row;
}

ElementVector<double> RandomElements(RandomNumbers& random, double size) {
  ElementVector<double> e;
  for (auto* four : {&e.pad_x, &e.pad_z, &e.nest, &e.wedge, &e.rim}) {
    for (double& value : *four) value = random(-size, size);
  }
  for (auto* two : {&e.guide_x, &e.plate_x}) {
    for (double& value : *two) value = random(-size, size);
  }
  return e;
}

TEST(Elements, ForcesAreTheTransposeOfDeflections) {
  RandomNumbers random;
  for (int i = 0; i < 200; ++i) {
    const BodyVector<double> velocity = random.Bodies(1.0);
    const ElementVector<double> force = RandomElements(random, 1e5);
    BodyVector<double> on_bodies{};
    AddElementForces(PaperWagon(), force, on_bodies);
    const double power_of_elements = Row(force).dot(Row(ElementsOf(PaperWagon(), velocity)));
    const double power_on_bodies = Row(on_bodies).dot(Row(velocity));
    EXPECT_NEAR(power_on_bodies, -power_of_elements, 1e-14 * 24 * 1e5 * 10.0);  // rounding of 24 products
  }
}

TEST(Elements, DeflectionsFromTheGeometry) {
  // A body alone displaced, checked by hand on the drawing: heights 0.485, 0.55, 2.0; half spacings 3.4825,
  // 0.975.
  const Wagon& w = PaperWagon();
  BodyVector<double> q{};
  q.pitch[kCarbody] = 1e-3;  // nose down: the front rims close, the rear ones open
  ElementVector<double> e = ElementsOf(w, q);
  EXPECT_NEAR(e.rim[0], 1e-3 * (3.4825 + 0.20), 1e-17);
  EXPECT_NEAR(e.rim[1], 1e-3 * (3.4825 - 0.20), 1e-17);
  EXPECT_NEAR(e.rim[3], -1e-3 * (3.4825 + 0.20), 1e-17);
  EXPECT_NEAR(e.plate_x[0], -1e-3 * (2.0 - 0.70), 1e-17);  // what is below the CG moves back
  EXPECT_NEAR(CouplerHead(w, q), -1e-3 * (2.0 - 0.85), 1e-17);
  q = {};
  q.pitch[kRearFrame] = 1e-3;
  e = ElementsOf(w, q);
  EXPECT_NEAR(e.pad_z[2], 1e-3 * 0.975, 1e-17);  // its front end comes down on wheelset 3
  EXPECT_NEAR(e.pad_z[3], -1e-3 * 0.975, 1e-17);
  EXPECT_NEAR(e.nest[2], -1e-3 * 0.15, 1e-17);  // and its nest there opens
  EXPECT_NEAR(e.wedge[3], 1e-3 * 0.25, 1e-17);
  EXPECT_NEAR(e.guide_x[1], -1e-3 * (0.55 - 0.485), 1e-17);
  EXPECT_EQ(e.pad_z[0], 0.0);
  q = {};
  q.z[kFrontBolster] = 1e-3;
  e = ElementsOf(w, q);
  EXPECT_NEAR(e.nest[0], -1e-3, 1e-17);
  EXPECT_NEAR(e.rim[1], 1e-3, 1e-17);
}

TEST(Elements, ARigidMotionDeflectsNothing) {
  const Wagon& w = PaperWagon();
  const double cg[kBodies] = {2.0, 0.55, 0.55, 0.485, 0.485, 0.485, 0.485, 0.485, 0.485};
  const double along[kBodies] = {0.0, 3.4825, -3.4825, 3.4825, -3.4825, 4.4575, 2.5075, -2.5075, -4.4575};
  BodyVector<double> q;
  for (int i = 0; i < kBodies; ++i) {  // 3 m forward, 0.02 m up and 0.01 rad about a point on the rail
    q.x[i] = 3.0 + 0.01 * cg[i];
    q.z[i] = 0.02 - 0.01 * along[i];
    q.pitch[i] = 0.01;
  }
  EXPECT_LT(Row(ElementsOf(w, q)).cwiseAbs().maxCoeff(), 2e-15);  // rounding of differences of 3 m
}

TEST(Elements, ElasticForcesAreTheSlopeOfThePotential) {
  const Wagon& w = PaperWagon();
  TrackParams hump;  // gentle enough to keep all wheels in contact
  hump.dips = {{-6.0, -2e-4, 11.0}};
  RandomNumbers random;
  for (int sample = 0; sample < 20; ++sample) {
    WagonState<double> s = StaticEquilibrium(w, 0.0, 0.0);
    const BodyVector<double> offset = random.Bodies(5e-5);  // nothing opens or meets a stop
    for (int i = 0; i < kBodies; ++i) {
      s.position.x[i] += offset.x[i];
      s.position.z[i] += offset.z[i];
      s.position.pitch[i] += 0.1 * offset.pitch[i];
    }
    BodyVector<double> force{};
    AddElementForces(w, ElasticForces(w, ElementsOf(w, s.position)), force);
    const RailForces<double> rail = ContactForces<true>(w, hump, {}, s);
    for (int i = 0; i < kBodies; ++i) force.z[i] -= kGravity * w.mass_kg[i];
    for (int i = 0; i < kWheelsets; ++i) {
      force.z[kWheelset1 + i] += rail.normal[i];
      force.x[kWheelset1 + i] -= rail.normal[i] * rail.slope[i];
    }
    const auto expect_slope = [&](double& coordinate, double generalised_force) {
      constexpr double kStep = 1e-6;
      const double at = coordinate;
      coordinate = at + kStep;
      const double ahead = PotentialEnergy(w, hump, s);
      coordinate = at - kStep;
      const double behind = PotentialEnergy(w, hump, s);
      coordinate = at;
      // Quadratic: only rounding, 1e-16 x 1e5 J / 1e-6 m = 1e-5 for each of some hundred terms.
      EXPECT_NEAR(-(ahead - behind) / (2.0 * kStep), generalised_force, 1e-3);
    };
    for (int i = 0; i < kBodies; ++i) {
      expect_slope(s.position.x[i], force.x[i]);
      expect_slope(s.position.z[i], force.z[i]);
      if (i < kWheelset1) expect_slope(s.position.pitch[i], force.pitch[i]);
    }
  }
}

TEST(Elements, DampersOnlyTakeEnergy) {
  RandomNumbers random;
  for (int i = 0; i < 500; ++i) {
    const ElementVector<double> deflection = RandomElements(random, 1e-3), rate = RandomElements(random, 0.5);
    const ElementVector<double> elastic = ElasticForces(PaperWagon(), deflection);
    const ElementVector<double> damping = DampingForces<true>(PaperWagon(), deflection, elastic, rate);
    EXPECT_GE((Row(damping).array() * Row(rate).array()).minCoeff(), 0.0);
    for (int k = 0; k < 4; ++k) EXPECT_GE(elastic.rim[k] + damping.rim[k], 0.0);  // the plate never pulls
  }
}

// ---- wedge friction
// -------------------------------------------------------------------------------------------------

struct WedgeProblem {
  std::array<double, 4> deflection, rate, free_rate;
};

WedgeProblem RandomWedges(RandomNumbers& random) {
  WedgeProblem p;
  const double size = std::pow(10.0, random(-6.0, 0.0));  // of the rates: from deep in stick to full sliding
  for (int i = 0; i < 4; ++i) {
    p.deflection[i] = random(-0.01, 0.07);
    p.rate[i] = random(-size, size);
    p.free_rate[i] = p.rate[i] + random(-size, size);
  }
  return p;
}

TEST(WedgeFriction, MeetsItsComplementarityLikeEveryCaseTriedInTurn) {
  const Wagon& w = PaperWagon();
  constexpr double kDt = 1e-3;
  RandomNumbers random;
  int cases_seen[3][3] = {};
  for (int sample = 0; sample < 20000; ++sample) {
    const WedgeProblem p = RandomWedges(random);
    const std::array<double, 4> f = WedgeFrictionForces(w, p.deflection, p.rate, p.free_rate, kDt);
    for (int bogie = 0; bogie < kBogies; ++bogie) {
      // How a pair of wedge forces changes the wedges' rates, through the wagon's own kinematics.
      Eigen::Matrix2d response;
      Eigen::Vector2d lower, upper;
      for (int end = 0; end < 2; ++end) {
        ElementVector<double> unit{};
        unit.wedge[2 * bogie + end] = 1.0;
        BodyVector<double> force{}, change{};
        AddElementForces(w, unit, force);
        Kick(w, force, kDt, kFrontBolster, kWheelset1, change, change);
        const ElementVector<double> rates = ElementsOf(w, change);
        response.col(end) << rates.wedge[2 * bogie], rates.wedge[2 * bogie + 1];
        const double spring = WedgeSpringForce(*w.params.friction_wedge, w.wedge.kappa * p.deflection[2 * bogie + end]);
        const auto bounds = WedgeFriction(w.wedge, 2.0 * spring, p.rate[2 * bogie + end]);
        lower[end] = bounds.lower;
        upper[end] = bounds.upper;
      }
      const Eigen::Vector2d free(p.free_rate[2 * bogie], p.free_rate[2 * bogie + 1]);
      const Eigen::Vector2d solved(f[2 * bogie], f[2 * bogie + 1]);
      const double force_scale = std::max(1e-3, upper.maxCoeff() - lower.minCoeff());
      const double rate_scale = std::max(free.cwiseAbs().maxCoeff(), response.cwiseAbs().maxCoeff() * force_scale);
      // 1e-8: the solver's own error after its four sweeps, 200^-4.
      const double force_eps = 1e-8 * force_scale, rate_eps = 1e-8 * rate_scale;

      // The conditions themselves.
      const Eigen::Vector2d rate = free + response * solved;
      for (int end = 0; end < 2; ++end) {
        EXPECT_GE(solved[end], lower[end] - force_eps);
        EXPECT_LE(solved[end], upper[end] + force_eps);
        EXPECT_TRUE(rate[end] <= rate_eps || std::abs(solved[end] - upper[end]) <= force_eps);
        EXPECT_TRUE(rate[end] >= -rate_eps || std::abs(solved[end] - lower[end]) <= force_eps);
      }

      // Each wedge loads, sticks or unloads: of the nine cases one fits, and it is the one found.
      int fitting = 0;
      for (int first = -1; first <= 1; ++first) {
        for (int second = -1; second <= 1; ++second) {
          const int mode[2] = {first, second};
          Eigen::Matrix2d a = Eigen::Matrix2d::Identity();
          Eigen::Vector2d b;
          for (int end = 0; end < 2; ++end) {
            b[end] = mode[end] > 0 ? upper[end] : lower[end];
            if (mode[end] == 0) {
              a.row(end) = response.row(end);
              b[end] = -free[end];
            }
          }
          const Eigen::Vector2d candidate = a.partialPivLu().solve(b), c = free + response * candidate;
          bool fits = true;
          for (int end = 0; end < 2; ++end) {
            if (mode[end] > 0) fits &= c[end] >= -rate_eps;
            if (mode[end] < 0) fits &= c[end] <= rate_eps;
            if (mode[end] == 0)
              fits &= candidate[end] >= lower[end] - force_eps && candidate[end] <= upper[end] + force_eps;
          }
          if (!fits) continue;
          ++fitting;
          ++cases_seen[first + 1][second + 1];
          EXPECT_NEAR((candidate - solved).cwiseAbs().maxCoeff(), 0.0,
                      3.0 * (force_eps + rate_eps / std::abs(response(0, 0))));
        }
      }
      EXPECT_GE(fitting, 1);
    }
  }
  for (const auto& row : cases_seen) {
    for (const int seen : row) EXPECT_GT(seen, 100);  // the sample has all nine in plenty
  }
}

// ---- static equilibrium
// ---------------------------------------------------------------------------------------------

// Deflection of the nests, from one scalar equation: half of carbody and two bolsters on four quarters of a
// bogie, each a half nest and a wedge whose spring acts with kappa and is travelled by kappa.
double NestDeflection(const VehicleParams& p) {
  const double load = 0.25 * 9.81 * (0.5 * p.carbody.mass_kg + p.bolster.mass_kg + 24.0);
  const double a = p.friction_wedge->wedge_angle_deg * std::acos(-1.0) / 180.0;
  const double g = p.friction_wedge->toe_angle_deg * std::acos(-1.0) / 180.0;
  const double kappa = std::sin(a) * std::cos(g) / std::sin(a + g);
  const auto quarter = [&](double d) {
    const auto staged = [](double outer, double inner, double x) {
      return outer * x + inner * std::max(0.0, x - 0.022);
    };
    return staged(1590e3, 566e3, d) + 4e8 * std::max(0.0, d - 0.074) +
           kappa * staged(983e3, p.friction_wedge->inner_stiffness_n_per_m, kappa * d);
  };
  double low = 0.0, high = 0.1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (quarter(middle) < load ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(StaticEquilibrium, CarriesAQuarterOfTheWeightOnEveryAxle) {
  const Wagon& w = PaperWagon();
  const WagonState<double> s = StaticEquilibrium(w, 0.0, 20.0);
  const RailForces<double> rail = ContactForces<true>(w, TrackParams(), {}, s);
  for (int i = 0; i < kWheelsets; ++i) EXPECT_NEAR(rail.normal[i], 0.25 * w.weight_n, 1e-9 * w.weight_n);
  EXPECT_NEAR(w.weight_n, 9.81 * 160113.8, 1e-6);
}

TEST(StaticEquilibrium, RestsAtTheDeflectionOfAScalarEquation) {
  VehicleParams p = OreWagon();
  EXPECT_NEAR(NestDeflection(p), 0.0585, 0.00005);  // half a unit of the notes' last digit
  for (const double inner : {566e3, 0.0}) {
    p.friction_wedge->inner_stiffness_n_per_m = inner;
    const Wagon w(p);
    const ElementVector<double> e = ElementsOf(w, StaticEquilibrium(w, 0.0, 0.0).position);
    // 1e-9 of the weight over 20 MN/m, the solver's own criterion.
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(e.nest[i], NestDeflection(p), 1e-10);
  }
  EXPECT_NEAR(NestDeflection(p), 0.0644, 0.0001);  // without the inner spring; one unit: the notes cut off
}

TEST(StaticEquilibrium, AnOverloadedWagonRestsOnItsSolidSprings) {
  VehicleParams p = OreWagon();
  p.carbody.mass_kg = 300e3;  // twice the load; the coils carry 192 t
  const Wagon w(p);
  const ElementVector<double> e = ElementsOf(w, StaticEquilibrium(w, 0.0, 0.0).position);
  EXPECT_GT(NestDeflection(p), 0.074);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(e.nest[i], NestDeflection(p), 1e-10);  // as above
}

TEST(StaticEquilibrium, AWagonThatItsSpringsCannotCarryIsRefused) {
  VehicleParams p = OreWagon();
  // Soft all the way, the eight half nests would have to yield by 90 000 km.
  p.spring_nest.outer_stiffness_n_per_m = p.spring_nest.solid_stiffness_n_per_m = 1e-3;
  p.spring_nest.inner_stiffness_n_per_m = 0.0;
  p.friction_wedge->outer_stiffness_n_per_m = 1e-6;
  p.friction_wedge->inner_stiffness_n_per_m = 0.0;
  const Wagon w(p);  // every number is one that a wagon may have
  EXPECT_THROW(StaticEquilibrium(w, 0.0, 0.0), std::invalid_argument);
}

TEST(StaticEquilibrium, NothingMovesBesideTheSpeed) {
  const Wagon& w = PaperWagon();
  const WagonState<double> s = StaticEquilibrium(w, 5.0, 20.0);
  EXPECT_EQ(Row(ElementsOf(w, s.velocity)).cwiseAbs().maxCoeff(),
            0.0);  // uniform translation deflects nothing
  for (int i = 0; i < kWheelsets; ++i) EXPECT_EQ(s.velocity.pitch[kWheelset1 + i], 20.0 / 0.485);
  const double rolling = 0.5 * (160113.8 + 4.0 * 679.0 / (0.485 * 0.485)) * 400.0;
  EXPECT_NEAR(KineticEnergy(w, s), rolling, 1e-12 * rolling);  // rounding
}

}  // namespace
}  // namespace train_dynamics
