#pragma once

#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// One time step of the wagon under loads that are held over it.
///
///   1. half drift: positions to the middle of the step;
///   2. compliant forces there, dampers at the rates of the step's start (largest elastic frequency about
///      1000 1/s, so that 1 ms is inside the explicit limit), weight, couplers, drag;
///   3. kick of carbody, bolsters and frames, with the wedges' set-valued friction as a complementarity problem
///      on the relative rates at the END of the step: they stick or slip without chatter;
///   4. kick of the wheelsets, with the creep forces implicit and the brake torque set-valued (StepRolling);
///   5. half drift.
///
/// A force times the mean of the rates before and after is its exact work in the step: the ledger books that.
/// Left out: the moment by which brake shoes turn the bogie frames, and the wedges' own inertia.
///
/// @param output  receives the step's contact and friction forces; may be null
template <class T>
void StepWagon(const Wagon& wagon, const Track& track, const VehicleLoads<T>& loads, double dt,
               WagonState<T>& s, WagonOutput<T>* output);

// ---------------------------------------------------------------------------------------------------------------------

/// q += h v
template <class T>
void Drift(const BodyVector<T>& v, double h, BodyVector<T>& q) {
  for (int i = 0; i < kBodies; ++i) {
    q.x[i] = q.x[i] + h * v.x[i];
    q.z[i] = q.z[i] + h * v.z[i];
    q.pitch[i] = q.pitch[i] + h * v.pitch[i];
  }
}

/// Contact forces between the four wheelsets and the rail at the step's middle.
template <class T>
struct RailForces {
  std::array<T, kWheelsets> normal{};   ///< N of both wheels [N]
  std::array<T, kWheelsets> damping{};  ///< the part of N that is not elastic [N]
  std::array<T, kWheelsets> slope{};    ///< of the rail [-]
  std::array<RailSurface<T>, kWheelsets> surface;
};

template <class T>
RailForces<T> ContactForces(const Wagon& w, const Track& track, const WagonState<T>& s) {
  const NormalContactParams& contact = w.params.wheel_rail.normal;
  RailForces<T> rail;
  for (int i = 0; i < kWheelsets; ++i) {
    const int b = kWheelset1 + i;
    const T at = s.origin_m + (s.position.x[b] + w.wheelset_offset_m[i]);
    const RailHeight<T> point = RailHeightUnder(track, at);
    const T penetration = point.height - s.position.z[b];
    const T rate = point.slope * s.velocity.x[b] - s.velocity.z[b];
    rail.normal[i] =
        2.0 * OneSidedForce(contact.stiffness_n_per_m, contact.damping_ns_per_m, penetration, rate);
    rail.damping[i] = rail.normal[i] - 2.0 * OneSidedForce(contact.stiffness_n_per_m, 0.0, penetration, rate);
    rail.slope[i] = point.slope;
    rail.surface[i] = RailSurfaceUnder(track, at, w.params.wheel_rail.adhesion);
  }
  return rail;
}

/// Friction forces of the wedges of all bogies that bring their relative rates to rest or reach their bounds.
///
/// Per bogie, with the compression rates c* that the wedges would have at the end of the step without
/// friction and the inverse masses W = [[a+b, a-b], [a-b, a+b]], a = 1/m_b + 1/m_f, b = offset^2 (1/I_b +
/// 1/I_f):
///
///   c = c* - dt W f,   lower <= f <= upper,   c > 0 -> f = upper (loading),   c < 0 -> f = lower
///
/// Projected Gauss-Seidel; the coupling |a-b| / (a+b) is about 0.07, so that each sweep gains a factor of
/// 200.
template <class T>
std::array<T, 4> WedgeFrictionForces(const Wagon& w, const std::array<T, 4>& deflection,
                                     const std::array<T, 4>& rate, const std::array<T, 4>& free_rate,
                                     double dt) {
  constexpr int kSweeps = 4;
  std::array<T, 4> f{};
  for (int bogie = 0; bogie < kBogies; ++bogie) {
    const int bolster = kFrontBolster + bogie, frame = kFrontFrame + bogie;
    const double a = w.inv_mass_per_kg[bolster] + w.inv_mass_per_kg[frame];
    const double offset = w.params.friction_wedge.offset_m;
    const double b = offset * offset * (w.inv_inertia_per_kgm2[bolster] + w.inv_inertia_per_kgm2[frame]);
    const double own = dt * (a + b), other = dt * (a - b), inv_own = 1.0 / own;
    WedgeFrictionBounds<T> bounds[2];
    for (int end = 0; end < 2; ++end) {
      const T travel = w.wedge.kappa * deflection[2 * bogie + end];
      bounds[end] = WedgeFriction(w.wedge, 2.0 * WedgeSpringForce(w.params.friction_wedge, travel),
                                  rate[2 * bogie + end]);
    }
    const T c0 = free_rate[2 * bogie], c1 = free_rate[2 * bogie + 1];
    T f0(0.0), f1(0.0);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      f0 = Clamp((c0 - other * f1) * inv_own, bounds[0].lower, bounds[0].upper);
      f1 = Clamp((c1 - other * f0) * inv_own, bounds[1].lower, bounds[1].upper);
    }
    f[2 * bogie] = f0;
    f[2 * bogie + 1] = f1;
  }
  return f;
}

/// Velocities after the forces have acted for dt on the bodies [begin, end).
template <class T>
void Kick(const Wagon& w, const BodyVector<T>& force, double dt, int begin, int end, BodyVector<T>& v) {
  for (int i = begin; i < end; ++i) {
    v.x[i] = v.x[i] + (dt * w.inv_mass_per_kg[i]) * force.x[i];
    v.z[i] = v.z[i] + (dt * w.inv_mass_per_kg[i]) * force.z[i];
    v.pitch[i] = v.pitch[i] + (dt * w.inv_inertia_per_kgm2[i]) * force.pitch[i];
  }
}

/// What acts on the wagon from outside in a step.
template <class T>
struct OuterForces {
  T grade;                                   ///< of the track [-]
  T coupler;                                 ///< of both couplers together, forward positive [N]
  T drag;                                    ///< of the air on the carbody, backwards positive [N]
  T shoes, rolling, dynamic_brake, curving;  ///< largest retarding forces at one wheelset [N], >= 0
  T traction;                                ///< at one wheelset, forward positive [N]
};

/// Outer forces with the carbody at the middle of the step and its speed at the start.
template <class T>
OuterForces<T> OuterForcesOn(const Wagon& w, const Track& track, const VehicleLoads<T>& loads,
                             const WagonState<T>& s) {
  const VehicleParams& p = w.params;
  const T speed = s.velocity.x[kCarbody];
  OuterForces<T> outer;
  outer.grade = GradeUnder(track, s.origin_m + s.position.x[kCarbody]);
  outer.coupler = loads.front_coupler_n - loads.rear_coupler_n;
  outer.drag = CopySign(AirDrag(p.propulsion_resistance, w.weight_n, speed), speed);
  outer.shoes = 0.25 * ShoeForce(p.brake_rigging, loads.cylinder_pressure_pa, speed);
  outer.rolling = 0.25 * RollingResistance(p.propulsion_resistance, w.weight_n, speed);
  outer.dynamic_brake = 0.25 * loads.dynamic_brake_n;
  outer.curving = 0.25 * loads.curving_resistance_n;
  outer.traction = 0.25 * loads.traction_n;
  return outer;
}

/// Adds weight, couplers and drag to the bodies' forces.
template <class T>
void AddOuterForces(const Wagon& w, const OuterForces<T>& outer, BodyVector<T>& force) {
  for (int i = 0; i < kBodies; ++i) {
    const double weight = kGravity * w.mass_kg[i];
    force.x[i] = force.x[i] - weight * outer.grade;
    force.z[i] = force.z[i] - weight;
  }
  force.x[kCarbody] = force.x[kCarbody] + (outer.coupler - outer.drag);
  force.pitch[kCarbody] = force.pitch[kCarbody] + w.coupler_arm_m * outer.coupler;
}

/// Sums over the wheelsets of a step.
template <class T>
struct WheelsetWork {
  T creep{}, contact{};             ///< energy lost in creep and in the contacts' dampers [J]
  T brake_path{}, traction_path{};  ///< way at the tread, times the share of the brake torque that acts [m]
};

/// The wheelsets' creep laws, frozen, and their implicit step on them (StepRolling).
/// @param shape_of  what the law of a surface takes beside mu0: of one surface for all lanes, or by lane
template <class T, class ShapeOf>
std::array<RollingResult<T>, kWheelsets> RollOn(const Wagon& w, const RailForces<T>& rail,
                                                const std::array<RollingInput<T>, kWheelsets>& rolling,
                                                double dt, const BodyVector<T>& v0, const ShapeOf& shape_of) {
  using Law = decltype(FreezeCreepLaw(shape_of(rail.surface[0]), 0.0, T(), T(), T(), 0.0));
  std::array<Law, kWheelsets> law;
  for (int i = 0; i < kWheelsets; ++i) {
    const RailSurface<T>& surface = rail.surface[i];
    law[i] = FreezeCreepLaw(shape_of(surface), w.creep_stiffness, rail.normal[i], surface.friction,
                            v0.x[kWheelset1 + i], w.params.wheel_rail.creepage_regularisation_speed_mps);
  }
  return StepRolling(w.rolling, law, rolling, dt);
}

/// RollOn where vehicles side by side meet different surfaces. A function of its own, so that the step of all
/// others does not grow.
template <class T>
[[gnu::noinline, gnu::flatten]] std::array<RollingResult<T>, kWheelsets> RollOnMixedSurfaces(
    const Wagon& w, const RailForces<T>& rail, const std::array<RollingInput<T>, kWheelsets>& rolling,
    double dt, const BodyVector<T>& v0) {
  return RollOn(w, rail, rolling, dt, v0, [](const RailSurface<T>& surface) { return ShapeOf(surface); });
}

/// Velocities of the wheelsets after the step.
/// @param force  on the wheelsets, without the rail's [N]
template <class T>
WheelsetWork<T> StepWheelsets(const Wagon& w, const RailForces<T>& rail, const OuterForces<T>& outer,
                              const BodyVector<T>& force, double dt, const BodyVector<T>& v0,
                              BodyVector<T>& v1, WagonOutput<T>* output) {
  const WheelRailParams& contact = w.params.wheel_rail;
  const double r = w.rolling.radius_m;
  const double v_ref = contact.creepage_regularisation_speed_mps;
  const T retarding = outer.shoes + outer.rolling + outer.dynamic_brake + outer.curving;
  std::array<RollingInput<T>, kWheelsets> rolling;
  bool mixed = false;
  for (int i = 0; i < kWheelsets; ++i) {
    const int b = kWheelset1 + i;
    mixed |= rail.surface[i].adhesion == nullptr;
    const T push = force.x[b] - rail.normal[i] * rail.slope[i];
    rolling[i] = {v0.x[b] + (dt * w.inv_mass_per_kg[b]) * push, v0.pitch[b], r * outer.traction,
                  r * retarding};
  }
  const std::array<RollingResult<T>, kWheelsets> rolled =
      mixed ? RollOnMixedSurfaces(w, rail, rolling, dt, v0)
            : RollOn(w, rail, rolling, dt, v0, [](const RailSurface<T>& surface) -> const AdhesionParams& {
                return *surface.adhesion;
              });

  WheelsetWork<T> work;
  for (int i = 0; i < kWheelsets; ++i) {
    const int b = kWheelset1 + i;
    const RollingInput<T>& in = rolling[i];
    const RollingResult<T>& out = rolled[i];
    v1.x[b] = out.speed;
    v1.pitch[b] = out.spin;
    v1.z[b] = v0.z[b] + (dt * w.inv_mass_per_kg[b]) * (force.z[b] + rail.normal[i]);

    const T turned = 0.5 * dt * (v0.pitch[b] + out.spin);
    const T moved = 0.5 * dt * (v0.x[b] + out.speed);
    const T lifted = 0.5 * dt * (v0.z[b] + v1.z[b]);
    const T mobilised = out.brake_torque / Max(T(1e-300), in.brake_torque);  // -1 ... 1
    work.creep = work.creep + out.creep_force * (moved - r * turned);
    work.contact = work.contact + rail.damping[i] * (rail.slope[i] * moved - lifted);
    work.brake_path = work.brake_path + mobilised * r * turned;
    work.traction_path = work.traction_path + r * turned;
    if (output != nullptr) {
      output->normal_force_n[i] = rail.normal[i];
      output->creep_force_n[i] = out.creep_force;
      output->creepage[i] = (out.speed - r * out.spin) / Sqrt(out.speed * out.speed + v_ref * v_ref);
      output->shoe_force_n[i] = outer.shoes * mobilised;
    }
  }
  return work;
}

/// Books the work of a step: force x mean rate x dt, element by element.
/// @param dissipative  forces of the dampers and of the wedges' friction
template <class T>
void BookWork(const Wagon& w, const OuterForces<T>& outer, const WheelsetWork<T>& wheelsets,
              const ElementVector<T>& dissipative, const ElementVector<T>& rate0, double dt,
              const BodyVector<T>& v0, const BodyVector<T>& v1, VehicleWork<T>& work) {
  const ElementVector<T> rate1 = ElementsOf(w, v1);
  const auto lost = [dt](const T& f, const T& r0, const T& r1) { return 0.5 * dt * f * (r0 + r1); };
  T pads(0.0), wedges(0.0), guides(0.0), plates(0.0);
  for (int i = 0; i < 4; ++i) {
    pads = pads + lost(dissipative.pad_x[i], rate0.pad_x[i], rate1.pad_x[i]) +
           lost(dissipative.pad_z[i], rate0.pad_z[i], rate1.pad_z[i]);
    wedges = wedges + lost(dissipative.wedge[i], rate0.wedge[i], rate1.wedge[i]);
    plates = plates + lost(dissipative.rim[i], rate0.rim[i], rate1.rim[i]);
  }
  for (int b = 0; b < kBogies; ++b) {
    guides = guides + lost(dissipative.guide_x[b], rate0.guide_x[b], rate1.guide_x[b]);
    plates = plates + lost(dissipative.plate_x[b], rate0.plate_x[b], rate1.plate_x[b]);
  }
  T mass_path(0.0);  // sum of mass x (v0 + v1): the grade acts on every body
  for (int i = 0; i < kBodies; ++i) mass_path = mass_path + w.mass_kg[i] * (v0.x[i] + v1.x[i]);

  const auto book = [&work](Dissipation element, const T& energy) {
    work.dissipated[element] = work.dissipated[element] + energy;
  };
  book(kWheelRailCreep, wheelsets.creep);
  book(kWheelRailNormal, wheelsets.contact);
  book(kAdaptorPads, pads);
  book(kFrictionWedges, wedges);
  book(kBolsterGuides, guides);
  book(kCentrePlates, plates);
  book(kBrakeShoes, outer.shoes * wheelsets.brake_path);
  book(kDynamicBrake, outer.dynamic_brake * wheelsets.brake_path);
  book(kRollingResistance, outer.rolling * wheelsets.brake_path);
  book(kCurvingResistance, outer.curving * wheelsets.brake_path);
  book(kAirDrag, lost(outer.drag, v0.x[kCarbody], v1.x[kCarbody]));
  work.gravity = work.gravity - (0.5 * dt * kGravity) * outer.grade * mass_path;
  work.traction = work.traction + outer.traction * wheelsets.traction_path;
}

template <class T>
void StepWagon(const Wagon& w, const Track& track, const VehicleLoads<T>& loads, double dt, WagonState<T>& s,
               WagonOutput<T>* output) {
  const BodyVector<T> v0 = s.velocity;
  BodyVector<T>& v1 = s.velocity;
  Drift(v0, 0.5 * dt, s.position);

  // Forces at the middle of the step.
  const ElementVector<T> deflection = ElementsOf(w, s.position);
  const ElementVector<T> rate0 = ElementsOf(w, v0);
  const ElementVector<T> elastic = ElasticForces(w, deflection);
  ElementVector<T> dissipative = DampingForces(w, deflection, elastic, rate0);
  const RailForces<T> rail = ContactForces(w, track, s);
  const OuterForces<T> outer = OuterForcesOn(w, track, loads, s);
  BodyVector<T> force;
  AddElementForces(w, elastic, force);
  AddElementForces(w, dissipative, force);
  AddOuterForces(w, outer, force);

  // Carbody, bolsters and frames, then the wedges' friction on these.
  Kick(w, force, dt, kCarbody, kWheelset1, v1);
  ElementVector<T> friction{};
  friction.wedge = WedgeFrictionForces(w, deflection.wedge, rate0.wedge, ElementsOf(w, v1).wedge, dt);
  BodyVector<T> friction_force;
  AddElementForces(w, friction, friction_force);
  Kick(w, friction_force, dt, kFrontBolster, kWheelset1, v1);

  const WheelsetWork<T> wheelsets = StepWheelsets(w, rail, outer, force, dt, v0, v1, output);
  if (output != nullptr) output->wedge_friction_n = friction.wedge;

  Drift(v1, 0.5 * dt, s.position);

  dissipative.wedge = friction.wedge;
  BookWork(w, outer, wheelsets, dissipative, rate0, dt, v0, v1, s.work);
}

}  // namespace train_dynamics
