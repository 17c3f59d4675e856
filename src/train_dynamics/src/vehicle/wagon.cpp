#include "train_dynamics/vehicle/wagon.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

#include "strict_config/validate.h"
#include "train_dynamics/contact/hertz.h"
#include "train_dynamics/contact/kalker.h"
#include "train_dynamics/contact/polach.h"

namespace train_dynamics {
namespace {

double CreepStiffnessOf(const VehicleParams& p) {
  const ContactEllipse ellipse = HertzEllipse(p.wheel_rail.hertz, p.wheelset.wheel_radius_m);
  const double c11 = KalkerC11(ellipse.a_per_cbrt_n / ellipse.b_per_cbrt_n, p.wheel_rail.hertz.poisson_ratio);
  return CreepStiffness(ellipse, p.wheel_rail.shear_modulus_pa, c11);
}

/// One number per vertical displacement and pitch.
template <int kPerBogie>
using VerticalVector = Eigen::Matrix<double, 2 * kBodiesOf<kPerBogie>, 1>;

/// Vertical and pitching forces on the bodies at rest, wedges without friction.
template <int kPerBogie>
VerticalVector<kPerBogie> VerticalForces(const BogieVehicle<kPerBogie>& w, const VerticalVector<kPerBogie>& q) {
  constexpr int kBodies = kBodiesOf<kPerBogie>;
  BodyVector<double, kPerBogie> position{}, force{};
  for (int i = 0; i < kBodies; ++i) {
    position.z[i] = q[i];
    position.pitch[i] = q[kBodies + i];
  }
  ElementVector<double, kPerBogie> elastic = ElasticForces(w, ElementsOf(w, position));
  elastic.pad_x = {};
  elastic.guide_x = elastic.plate_x = {};
  AddElementForces(w, elastic, force);
  VerticalVector<kPerBogie> f;
  for (int i = 0; i < kBodies; ++i) {
    f[i] = force.z[i] - kGravity * w.mass_kg[i];
    f[kBodies + i] = force.pitch[i];
  }
  for (int i = kWheelset1; i < kBodies; ++i) {
    f[i] += 2.0 * OneSidedForce(w.params.wheel_rail.normal.stiffness_n_per_m, 0.0, -q[i], 0.0);
    f[kBodies + i] = -q[kBodies + i];  // the wheels' rotation is free: hold it
  }
  return f;
}

/// In the place of wedges where a vehicle has none: without springs, without forces.
constexpr FrictionWedgeParams kNoWedge = {0.0, 0.0, 0.0, 45.0, 0.0, 0.0, 0.0, 1.0, 1.0};

/// The wedges of a bogie are solved by sweeps, whose number suits a weak coupling (WedgeFrictionForces).
template <int kPerBogie>
void CheckWedgeCoupling(const BogieVehicle<kPerBogie>& w) {
  const double offset = w.wedge.params.offset_m;
  const double both = w.inv_mass_per_kg[kFrontBolster] + w.inv_mass_per_kg[kFrontFrame];
  const double turn = offset * offset * (w.inv_inertia_per_kgm2[kFrontBolster] + w.inv_inertia_per_kgm2[kFrontFrame]);
  constexpr double kStrongestCoupling = 0.5;
  if (std::abs(both - turn) > kStrongestCoupling * (both + turn)) {
    throw std::invalid_argument(
        "friction_wedge.offset_m couples the wedges of a bogie too strongly for the time step: "
        "it must be nearer to " +
        std::to_string(offset * std::sqrt(both / turn)) + " m");
  }
}

}  // namespace

template <int kPerBogie>
BogieVehicle<kPerBogie>::BogieVehicle(const VehicleParams& vehicle)
    : params(vehicle), wedge(vehicle.friction_wedge.value_or(kNoWedge)), rigging(vehicle.Rigging()) {
  strict_config::Validate(params);
  if (params.wheelsets_per_bogie != kPerBogie) {
    throw std::invalid_argument("wheelsets_per_bogie must be " + std::to_string(kPerBogie) + ", got " +
                                std::to_string(params.wheelsets_per_bogie));
  }
  const VehicleParams& p = params;
  const auto set_body = [this](int i, double mass, double inertia) {
    mass_kg[i] = mass;
    inv_mass_per_kg[i] = 1.0 / mass;
    inertia_kgm2[i] = inertia;
    inv_inertia_per_kgm2[i] = 1.0 / inertia;
  };
  const BodyParams carbody = p.LoadedCarbody();
  set_body(kCarbody, carbody.mass_kg, carbody.pitch_inertia_kgm2);
  for (int b = 0; b < kBogies; ++b) {
    set_body(kFrontBolster + b, p.bolster.mass_kg + 4.0 * p.wedge_mass_kg, p.bolster.pitch_inertia_kgm2);
    set_body(kFrontFrame + b, p.bogie_frame.mass_kg, p.bogie_frame.pitch_inertia_kgm2);
    bogie_offset_m[b] = b == 0 ? p.half_bogie_spacing_m : -p.half_bogie_spacing_m;
  }
  for (int i = 0; i < kWheelsets; ++i) {
    set_body(kWheelset1 + i, p.wheelset.mass_kg, p.PitchInertia(i));
    const int bogie = BogieOfWheelset<kPerBogie>(i), place = i % kPerBogie;  // 0 = front
    double offset = bogie == 0 ? p.middle_wheelset_offset_m : -p.middle_wheelset_offset_m;
    if (place == 0) offset = p.half_wheelset_spacing_m;
    if (place == kPerBogie - 1) offset = -p.half_wheelset_spacing_m;
    wheelset_offset_m[i] = bogie_offset_m[bogie] + offset;
  }
  for (int i = 0; i < kQuarters; ++i) {
    const double end = i % 2 == 0 ? 1.0 : -1.0;
    nest_offset_m[i] = end * p.spring_nest.offset_m;
    wedge_offset_m[i] = end * wedge.params.offset_m;
    rim_offset_m[i] = end * p.centre_plate.rim_offset_m;
  }
  pad_frame_arm_m = p.wheelset.wheel_radius_m - p.bogie_frame.cg_height_m;
  guide_bolster_arm_m = p.bolster_guide_height_m - p.bolster.cg_height_m;
  guide_frame_arm_m = p.bolster_guide_height_m - p.bogie_frame.cg_height_m;
  plate_carbody_arm_m = p.centre_plate.height_m - carbody.cg_height_m;
  plate_bolster_arm_m = p.centre_plate.height_m - p.bolster.cg_height_m;
  coupler_arm_m = p.coupler_height_m - carbody.cg_height_m;
  if (params.friction_wedge) CheckWedgeCoupling(*this);
  weight_n = p.Weight();
  resistance = p.Resistance();
  creep_stiffness = CreepStiffnessOf(p);
  rolling = {p.wheelset.wheel_radius_m, 1.0 / p.wheelset.mass_kg, 1.0 / p.PitchInertia(0)};
  rolling_of_each.radius_m = rolling.radius_m;
  rolling_of_each.inv_mass_per_kg = rolling.inv_mass_per_kg;
  const int driven_wheelsets = p.traction ? p.traction->DrivenOf(kWheelsets) : kWheelsets;
  driven_share = 1.0 / driven_wheelsets;
  some_driven = driven_wheelsets < kWheelsets;
  for (int i = 0; i < kWheelsets; ++i) {
    driven[i] = !p.traction || p.traction->Drives(i) ? 1.0 : 0.0;
    rolling_of_each.inv_inertia_per_kgm2[i] = 1.0 / p.PitchInertia(i);
  }
}

template <int kPerBogie>
WagonState<double, kPerBogie> StaticEquilibrium(const BogieVehicle<kPerBogie>& wagon, double origin_m,
                                                double speed_mps) {
  using Vector = VerticalVector<kPerBogie>;
  constexpr int kBodies = kBodiesOf<kPerBogie>;
  // Newton's method on piecewise linear forces, started with all springs under load; ends exactly once the
  // active pieces are right.
  Vector q = Vector::Zero();
  for (int i = 0; i < kBodies; ++i) q[i] = i >= kWheelset1 ? -1e-4 : i >= kFrontFrame ? -2e-3 : -0.05;
  q[kCarbody] -= 1e-3;
  bool settled = false;
  for (int iteration = 0; iteration < 50 && !settled; ++iteration) {
    const Vector f = VerticalForces(wagon, q);
    Eigen::Matrix<double, 2 * kBodies, 2 * kBodies> slope;
    constexpr double kProbe = 1e-7;
    for (int k = 0; k < 2 * kBodies; ++k) {
      Vector ahead = q, behind = q;
      ahead[k] += kProbe;
      behind[k] -= kProbe;
      slope.col(k) = (VerticalForces(wagon, ahead) - VerticalForces(wagon, behind)) / (2.0 * kProbe);
    }
    const Vector step = slope.partialPivLu().solve(f);
    q -= step;
    settled = step.cwiseAbs().maxCoeff() < 1e-14;
  }
  if (!(VerticalForces(wagon, q).cwiseAbs().maxCoeff() < 1e-9 * wagon.weight_n)) {
    throw std::invalid_argument("vehicle " + wagon.params.name +
                                " has no static equilibrium: its springs cannot carry its weight");
  }
  WagonState<double, kPerBogie> s;
  s.origin_m = origin_m;
  for (int i = 0; i < kBodies; ++i) {
    s.position.z[i] = q[i];
    s.position.pitch[i] = i >= kWheelset1 ? 0.0 : q[kBodies + i];
    s.velocity.x[i] = speed_mps;
    if (i >= kWheelset1) s.velocity.pitch[i] = speed_mps / wagon.params.wheelset.wheel_radius_m;
  }
  return s;
}

template <int kPerBogie>
double KineticEnergy(const BogieVehicle<kPerBogie>& w, const WagonState<double, kPerBogie>& s) {
  double twice = 0.0;
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    twice += w.mass_kg[i] * (s.velocity.x[i] * s.velocity.x[i] + s.velocity.z[i] * s.velocity.z[i]) +
             w.inertia_kgm2[i] * s.velocity.pitch[i] * s.velocity.pitch[i];
  }
  return 0.5 * twice;
}

template <int kPerBogie>
double PotentialEnergy(const BogieVehicle<kPerBogie>& w, const Track& track, const WagonState<double, kPerBogie>& s) {
  const VehicleParams& p = w.params;
  const ElementVector<double, kPerBogie> e = ElementsOf(w, s.position);
  const auto spring = [](const LinearSpringDamper& law, double d) { return 0.5 * law.stiffness_n_per_m * d * d; };
  double energy = 0.0;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    energy += 2.0 * (spring(p.adaptor_pad, e.pad_x[i]) + spring(p.adaptor_pad, e.pad_z[i]));
  }
  for (int i = 0; i < kQuarters; ++i) {
    energy += 2.0 * SpringNestEnergy(p.spring_nest, e.nest[i]);
    energy += 2.0 * WedgeSpringEnergy(w.wedge.params, w.wedge.kappa * e.wedge[i]);
    energy += RimEnergy(p.centre_plate, e.rim[i]);
  }
  for (int b = 0; b < kBogies; ++b) {
    energy += spring(p.bolster_guide, e.guide_x[b]);
    energy += 0.5 * p.centre_plate.stiffness_n_per_m * e.plate_x[b] * e.plate_x[b];
  }
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) energy += kGravity * w.mass_kg[i] * s.position.z[i];
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    const RailHeight<double> rail = RailHeightAt(track, s.origin_m + (s.position.x[b] + w.wheelset_offset_m[i]));
    energy += 2.0 * OneSidedEnergy(p.wheel_rail.normal.stiffness_n_per_m, rail.height - s.position.z[b]);
  }
  return energy;
}

template struct BogieVehicle<2>;
template struct BogieVehicle<3>;
template WagonState<double, 2> StaticEquilibrium(const BogieVehicle<2>&, double, double);
template WagonState<double, 3> StaticEquilibrium(const BogieVehicle<3>&, double, double);
template double KineticEnergy(const BogieVehicle<2>&, const WagonState<double, 2>&);
template double KineticEnergy(const BogieVehicle<3>&, const WagonState<double, 3>&);
template double PotentialEnergy(const BogieVehicle<2>&, const Track&, const WagonState<double, 2>&);
template double PotentialEnergy(const BogieVehicle<3>&, const Track&, const WagonState<double, 3>&);

}  // namespace train_dynamics
