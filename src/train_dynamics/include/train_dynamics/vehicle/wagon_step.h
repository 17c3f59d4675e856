#pragma once

#include <limits>

#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// One time step of the wagon under loads that are held over it.
///
///   1. half drift: positions to the middle of the step;
///   2. compliant forces there, dampers at the rates of the step's start (largest elastic frequency about
///      1000 1/s, so that 1 ms is inside the explicit limit), weight, couplers, drag;
///   3. kick of the wheelsets, with the creep forces implicit and the brake torque set-valued (StepRolling);
///   4. kick of carbody, bolsters and frames, which get the opposite of the torques of step 3
///      (AddReactions), with the wedges' set-valued friction as a complementarity problem on the relative
///      rates at the END of the step: they stick or slip without chatter;
///   5. half drift.
///
/// A force times the mean of the rates before and after is its exact work in the step: the ledger books that.
/// Left out: the wedges' own inertia; and a locked wheel is held against the ground, omega = 0, not against its
/// frame, whose pitch rate is 1e-3 of the wheels' at most.
///
/// @param output  receives the step's contact and friction forces; may be null
template <class T, int kPerBogie>
void StepWagon(const BogieVehicle<kPerBogie>& wagon, const Track& track, const VehicleLoads<T>& loads, double dt,
               WagonState<T, kPerBogie>& s, WagonOutput<T, kPerBogie>* output);

/// The same, compiled for a kind of vehicle and rail.
/// @tparam kAll  false: leaves out what plain vehicles (BogieVehicle::IsPlain) do not have, the loads that few trains
///               have (Given::kWhereUsed), and the look-up of dips and surfaces; without these the bits are the same
///               and the time is less
/// @tparam kReacts  whether torques on wheelsets may react on the vehicle (BrakeReaction)
/// @param surface  the one under all wheels, which is on no dip, see FindOneSurface; of kAll = false
template <bool kAll, bool kReacts, class T, int kPerBogie>
void StepWagonWith(const BogieVehicle<kPerBogie>& wagon, const Track& track, const OneSurface& surface,
                   const VehicleLoads<T>& loads, double dt, WagonState<T, kPerBogie>& s,
                   WagonOutput<T, kPerBogie>* output);

/// Whether torques on the wheelsets react on the vehicle.
template <int kPerBogie>
bool Reacts(const BogieVehicle<kPerBogie>& wagon) {
  return wagon.params.brake_rigging.reaction != BrakeReaction::kNone;
}

// ---------------------------------------------------------------------------------------------------------------------

/// q += h v
template <class T, int kPerBogie>
void Drift(const BodyVector<T, kPerBogie>& v, double h, BodyVector<T, kPerBogie>& q) {
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    q.x[i] = q.x[i] + h * v.x[i];
    q.z[i] = q.z[i] + h * v.z[i];
    q.pitch[i] = q.pitch[i] + h * v.pitch[i];
  }
}

/// Contact forces between the wheelsets and the rail at the step's middle.
template <class T, int kPerBogie = 2>
struct RailForces {
  std::array<T, kWheelsetsOf<kPerBogie>> normal{};   ///< N of both wheels [N]
  std::array<T, kWheelsetsOf<kPerBogie>> damping{};  ///< the part of N that is not elastic [N]
  std::array<T, kWheelsetsOf<kPerBogie>> slope{};    ///< of the rail [-]
  std::array<RailSurface<T>, kWheelsetsOf<kPerBogie>> surface;
};

/// Where a wheelset is on the track [m]. @param x  of its body [m]
template <class T, int kPerBogie>
T WheelsetPosition(const BogieVehicle<kPerBogie>& w, const T& origin_m, const T& x, int wheelset) {
  return origin_m + (x + w.wheelset_offset_m[wheelset]);
}

template <class T, int kPerBogie>
bool FindOneSurface(const BogieVehicle<kPerBogie>& w, const Track& track, double dt, const WagonState<T, kPerBogie>& s,
                    OneSurface& surface) {
  Stretch under{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    const T x = s.position.x[b] + 0.5 * dt * s.velocity.x[b];  // as Drift has it
    double at[kLanesOf<T>];
    Store(WheelsetPosition(w, s.origin_m, x, i), at);
    for (const double one : at) under = {Min(one, under.from_m), Max(one, under.to_m)};
  }
  const auto holds = [under](const Stretch& on) { return on.from_m <= under.from_m && under.to_m < on.to_m; };
  surface = OwnSurface<T>(w.params.wheel_rail.adhesion);
  if (track.has_dips && !holds(track.FlatFrom(under.from_m))) return false;
  if (!track.has_patches) return true;
  const Track::SurfaceStretch one = track.SurfaceFrom(under.from_m, w.params.wheel_rail.adhesion);
  if (!holds(one.on)) return false;
  surface = {one.friction, one.adhesion};
  return true;
}

/// kAll and surface: see StepWagonWith.
template <bool kAll, class T, int kPerBogie>
RailForces<T, kPerBogie> ContactForces(const BogieVehicle<kPerBogie>& w, const Track& track, const OneSurface& surface,
                                       const WagonState<T, kPerBogie>& s) {
  const NormalContactParams& contact = w.params.wheel_rail.normal;
  RailForces<T, kPerBogie> rail;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    RailHeight<T> point{T(0.0), T(0.0)};
    rail.surface[i] = Under<T>(surface);
    if constexpr (kAll) {
      const T at = WheelsetPosition(w, s.origin_m, s.position.x[b], i);
      point = RailHeightUnder(track, at);
      rail.surface[i] = RailSurfaceUnder(track, at, w.params.wheel_rail.adhesion);
    }
    const T penetration = point.height - s.position.z[b];
    const T rate = point.slope * s.velocity.x[b] - s.velocity.z[b];
    rail.normal[i] = 2.0 * OneSidedForce(contact.stiffness_n_per_m, contact.damping_ns_per_m, penetration, rate);
    rail.damping[i] = rail.normal[i] - 2.0 * OneSidedForce(contact.stiffness_n_per_m, 0.0, penetration, rate);
    rail.slope[i] = point.slope;
  }
  return rail;
}

/// ContactForces on any track. A function of its own: its look-ups would take registers from the rest of the step.
template <class T, int kPerBogie>
[[gnu::noinline]] TRAIN_DYNAMICS_FLATTEN RailForces<T, kPerBogie> ContactForcesOnAnyTrack(
    const BogieVehicle<kPerBogie>& w, const Track& track, const WagonState<T, kPerBogie>& s) {
  return ContactForces<true>(w, track, {}, s);
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
template <class T, int kPerBogie>
std::array<T, kQuarters> WedgeFrictionForces(const BogieVehicle<kPerBogie>& w,
                                             const std::array<T, kQuarters>& deflection,
                                             const std::array<T, kQuarters>& rate,
                                             const std::array<T, kQuarters>& free_rate, double dt) {
  constexpr int kSweeps = 4;
  std::array<T, kQuarters> f{};
  for (int bogie = 0; bogie < kBogies; ++bogie) {
    const int bolster = kFrontBolster + bogie, frame = kFrontFrame + bogie;
    const double a = w.inv_mass_per_kg[bolster] + w.inv_mass_per_kg[frame];
    const double offset = w.wedge.params.offset_m;
    const double b = offset * offset * (w.inv_inertia_per_kgm2[bolster] + w.inv_inertia_per_kgm2[frame]);
    const double own = dt * (a + b), other = dt * (a - b), inv_own = 1.0 / own;
    WedgeFrictionBounds<T> bounds[2];
    for (int end = 0; end < 2; ++end) {
      const T travel = w.wedge.kappa * deflection[2 * bogie + end];
      bounds[end] = WedgeFriction(w.wedge, 2.0 * WedgeSpringForce(w.wedge.params, travel), rate[2 * bogie + end]);
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

/// Velocities `v1` of the bodies [begin, end) after the forces have acted for dt on bodies of velocities `v0`. Both may
/// be the same.
template <class T, int kPerBogie>
void Kick(const BogieVehicle<kPerBogie>& w, const BodyVector<T, kPerBogie>& force, double dt, int begin, int end,
          const BodyVector<T, kPerBogie>& v0, BodyVector<T, kPerBogie>& v1) {
  for (int i = begin; i < end; ++i) {
    v1.x[i] = v0.x[i] + (dt * w.inv_mass_per_kg[i]) * force.x[i];
    v1.z[i] = v0.z[i] + (dt * w.inv_mass_per_kg[i]) * force.z[i];
    v1.pitch[i] = v0.pitch[i] + (dt * w.inv_inertia_per_kgm2[i]) * force.pitch[i];
  }
}

/// External loads on the wagon in a step.
template <class T>
struct OuterForces {
  T grade;              ///< of the track [-]
  T coupler;            ///< of both couplers together, forward positive [N]
  T drag;               ///< of the air on the carbody, backwards positive [N]
  T shoe_load;          ///< normal load of the shoes of one wheelset [N], >= 0
  T shoes;              ///< their largest friction at the vehicle's speed [N], >= 0
  T rolling;            ///< largest resistance at one wheelset [N], >= 0
  T curving;            ///< the same of curves, on the wheelset's centre [N], >= 0
  T dynamic_brake;      ///< largest at one driven wheelset [N], >= 0
  T traction;           ///< at one driven wheelset, forward positive [N]
  T cylinder_pressure;  ///< [Pa]
  T icy_factor;         ///< on the shoes' friction [-]; of vehicles whose shoes are not plain
  const std::array<T, kMostWheelsets>*wheelset_pressure, *traction_share;  ///< see VehicleLoads
};

/// Outer forces with the carbody at the middle of the step and its speed at the start.
template <bool kAll, class T, int kPerBogie>
OuterForces<T> OuterForcesOn(const BogieVehicle<kPerBogie>& w, const Track& track, const VehicleLoads<T>& loads,
                             const WagonState<T, kPerBogie>& s) {
  const VehicleParams& p = w.params;
  const T speed = s.velocity.x[kCarbody];
  OuterForces<T> outer;
  outer.grade = GradeUnder(track, s.origin_m + s.position.x[kCarbody]);
  outer.coupler = loads.front_coupler_n - loads.rear_coupler_n;
  outer.drag = CopySign(AirDrag(w.resistance, w.weight_n, speed), speed);
  constexpr double kShare = 1.0 / kWheelsetsOf<kPerBogie>;
  outer.shoe_load = kShare * w.rigging.load_per_pressure_n_per_pa * loads.cylinder_pressure_pa;
  outer.shoes = T(0.0);
  if (p.brake_rigging.friction_speed == FrictionSpeed::kVehicle) {
    outer.shoes = kShare * ShoeForce(w.rigging, loads.cylinder_pressure_pa, speed);
  }
  outer.rolling = kShare * RollingResistance(w.resistance, w.weight_n, speed);
  if (kAll) outer.rolling = Max(outer.rolling, kShare * loads.breakaway_resistance_n);
  outer.curving = kShare * loads.curving_resistance_n;
  outer.dynamic_brake = w.driven_share * loads.dynamic_brake_n;
  outer.traction = w.driven_share * loads.traction_n;
  outer.cylinder_pressure = loads.cylinder_pressure_pa;
  outer.icy_factor = T(1.0);
  if (kAll && p.brake_rigging.shoe_friction.icy) {
    outer.icy_factor = IcyFactor(*p.brake_rigging.shoe_friction.icy, 0.5 * kShare * s.work.dissipated[kBrakeShoes]);
  }
  outer.wheelset_pressure = loads.wheelset_pressure_pa;
  outer.traction_share = loads.traction_share;
  return outer;
}

/// Adds weight, couplers and drag to the bodies' forces.
template <class T, int kPerBogie>
void AddOuterForces(const BogieVehicle<kPerBogie>& w, const OuterForces<T>& outer, BodyVector<T, kPerBogie>& force) {
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    const double weight = kGravity * w.mass_kg[i];
    force.x[i] = force.x[i] - weight * outer.grade;
    force.z[i] = force.z[i] - weight;
  }
  force.x[kCarbody] = force.x[kCarbody] + (outer.coupler - outer.drag);
  force.pitch[kCarbody] = force.pitch[kCarbody] + w.coupler_arm_m * outer.coupler;
}

/// Friction of the shoes of each wheelset [N], >= 0.
template <class T, int kPerBogie = 2>
struct ShoeForces {
  std::array<T, kWheelsetsOf<kPerBogie>> turning;   ///< on the wheels as they turn
  std::array<T, kWheelsetsOf<kPerBogie>> standing;  ///< the most on wheels at rest, >= turning
};

/// The same by any rigging and law of friction, and where each wheelset has a cylinder pressure of its own.
template <class T, int kPerBogie>
[[gnu::noinline]] TRAIN_DYNAMICS_FLATTEN ShoeForces<T, kPerBogie> ShoeForcesOfCylinders(
    const BogieVehicle<kPerBogie>& w, const std::array<T, kMostWheelsets>& pressure, T icy_factor,
    const BodyVector<T, kPerBogie>& v0) {
  constexpr double kShare = 1.0 / kWheelsetsOf<kPerBogie>;
  const bool by_vehicle = w.params.brake_rigging.friction_speed == FrictionSpeed::kVehicle;
  ShoeForces<T, kPerBogie> shoes;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const T speed = by_vehicle ? v0.x[kCarbody] : w.rolling.radius_m * v0.pitch[kWheelset1 + i];
    const T share = kShare * icy_factor;
    shoes.turning[i] = share * ShoeForce(w.rigging, pressure[i], speed);
    shoes.standing[i] = by_vehicle ? shoes.turning[i] : share * ShoeForce(w.rigging, pressure[i], T(0.0));
  }
  return shoes;
}

template <class T, int kPerBogie>
ShoeForces<T, kPerBogie> ShoeForcesOn(const BogieVehicle<kPerBogie>& w, const OuterForces<T>& outer,
                                      const BodyVector<T, kPerBogie>& v0) {
  if (outer.wheelset_pressure != nullptr)
    return ShoeForcesOfCylinders(w, *outer.wheelset_pressure, outer.icy_factor, v0);
  if (!w.rigging.is_plain) {
    std::array<T, kMostWheelsets> pressure;
    pressure.fill(outer.cylinder_pressure);
    return ShoeForcesOfCylinders(w, pressure, outer.icy_factor, v0);
  }
  const BrakeRiggingParams& rigging = w.params.brake_rigging;
  ShoeForces<T, kPerBogie> shoes;
  if (rigging.friction_speed == FrictionSpeed::kVehicle) {
    for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) shoes.turning[i] = shoes.standing[i] = outer.shoes;
    return shoes;
  }
  const T standing = outer.shoe_load * rigging.shoe_friction.standstill_friction_coefficient;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const T tread = w.rolling.radius_m * v0.pitch[kWheelset1 + i];
    shoes.turning[i] = outer.shoe_load * ShoeFriction(rigging.shoe_friction, tread);
    shoes.standing[i] = standing;
  }
  return shoes;
}

/// Result of a step for the wheelsets.
template <class T, int kPerBogie = 2>
struct WheelsetStep {
  ShoeForces<T, kPerBogie> shoes;
  /// The share of the retarding torque that acts, -1 ... 1; forward turning: positive.
  std::array<T, kWheelsetsOf<kPerBogie>> mobilised;
  std::array<T, kWheelsetsOf<kPerBogie>> path;          ///< at the tread, of the rotation [m]
  std::array<T, kWheelsetsOf<kPerBogie>> creep, brake;  ///< energy lost in creep; work on the rail [J]
  std::array<T, kWheelsetsOf<kPerBogie>> traction{};    ///< at the tread, forward positive [N]
  T contact{}, curving{};                               ///< energy lost in the contacts' dampers and to curves [J]
};

/// The wheelsets' creep laws, frozen, and their implicit step on them (StepRolling).
/// @param shape_of  what the law of a surface takes beside mu0: of one surface for all lanes, or by lane
template <class T, int kPerBogie, class Inertia, class ShapeOf>
std::array<RollingResult<T>, kWheelsetsOf<kPerBogie>> RollOn(
    const BogieVehicle<kPerBogie>& w, const RailForces<T, kPerBogie>& rail,
    const std::array<RollingInput<T>, kWheelsetsOf<kPerBogie>>& rolling, double dt, const BodyVector<T, kPerBogie>& v0,
    const Inertia& inertia, const ShapeOf& shape_of) {
  using Law = decltype(FreezeCreepLaw(shape_of(rail.surface[0]), 0.0, T(), T(), T(), 0.0));
  std::array<Law, kWheelsetsOf<kPerBogie>> law;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const RailSurface<T>& surface = rail.surface[i];
    law[i] = FreezeCreepLaw(shape_of(surface), w.creep_stiffness, rail.normal[i], surface.friction,
                            v0.x[kWheelset1 + i], w.params.wheel_rail.creepage_regularisation_speed_mps);
  }
  return StepRolling(inertia, law, rolling, dt);
}

/// RollOn where vehicles side by side meet different surfaces, or some wheelsets have drives. A function of its own, so
/// that the step of all others does not grow.
template <class T, int kPerBogie>
[[gnu::noinline]] TRAIN_DYNAMICS_FLATTEN std::array<RollingResult<T>, kWheelsetsOf<kPerBogie>> RollOnMixed(
    const BogieVehicle<kPerBogie>& w, const RailForces<T, kPerBogie>& rail,
    const std::array<RollingInput<T>, kWheelsetsOf<kPerBogie>>& rolling, double dt,
    const BodyVector<T, kPerBogie>& v0) {
  return RollOn(w, rail, rolling, dt, v0, w.rolling_of_each,
                [](const RailSurface<T>& surface) { return ShapeOf(surface); });
}

/// Velocities of the wheelsets after the step.
/// @param force  on the wheelsets, without the rail's [N]
template <bool kAll, class T, int kPerBogie>
WheelsetStep<T, kPerBogie> StepWheelsets(const BogieVehicle<kPerBogie>& w, const RailForces<T, kPerBogie>& rail,
                                         const OuterForces<T>& outer, const BodyVector<T, kPerBogie>& force, double dt,
                                         const BodyVector<T, kPerBogie>& v0, BodyVector<T, kPerBogie>& v1,
                                         WagonOutput<T, kPerBogie>* output) {
  const WheelRailParams& contact = w.params.wheel_rail;
  const double r = w.rolling.radius_m;
  const double v_ref = contact.creepage_regularisation_speed_mps;
  WheelsetStep<T, kPerBogie> step;
  step.shoes = ShoeForcesOn(w, outer, v0);
  std::array<RollingInput<T>, kWheelsetsOf<kPerBogie>> rolling;
  std::array<T, kWheelsetsOf<kPerBogie>> curving{};  // backwards positive
  bool mixed = kAll && w.some_driven;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    mixed |= kAll && rail.surface[i].adhesion == nullptr;
    T push = force.x[b] - rail.normal[i] * rail.slope[i];
    T traction = outer.traction, others = outer.rolling + outer.dynamic_brake;
    if (kAll) {
      // Set-valued at rest: the force that stops the wheelset, the creep force excluded, up to its limit.
      curving[i] = Clamp(w.mass_kg[b] * (1.0 / dt) * v0.x[b] + push, -outer.curving, outer.curving);
      push = push - curving[i];
      traction = w.driven[i] * outer.traction;
      if (outer.traction_share != nullptr) traction = (*outer.traction_share)[i] * traction;
      step.traction[i] = traction;
      others = outer.rolling + w.driven[i] * outer.dynamic_brake;
    }
    rolling[i] = {v0.x[b] + (dt * w.inv_mass_per_kg[b]) * push,
                  v0.pitch[b],
                  r * traction,
                  r * (step.shoes.turning[i] + others),
                  r * (step.shoes.standing[i] + others),
                  v0.x[b] - r * v0.pitch[b]};
  }
  const std::array<RollingResult<T>, kWheelsetsOf<kPerBogie>> rolled =
      mixed ? RollOnMixed(w, rail, rolling, dt, v0)
            : RollOn(w, rail, rolling, dt, v0, w.rolling,
                     [](const RailSurface<T>& surface) -> const AdhesionParams& { return *surface.adhesion; });

  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    const RollingResult<T>& out = rolled[i];
    v1.x[b] = out.speed;
    v1.pitch[b] = out.spin;
    v1.z[b] = v0.z[b] + (dt * w.inv_mass_per_kg[b]) * (force.z[b] + rail.normal[i]);

    const T turned = 0.5 * dt * (v0.pitch[b] + out.spin);
    const T moved = 0.5 * dt * (v0.x[b] + out.speed);
    const T lifted = 0.5 * dt * (v0.z[b] + v1.z[b]);
    step.path[i] = r * turned;
    step.mobilised[i] = out.brake_torque / Max(T(1e-300), rolling[i].brake_torque);
    step.brake[i] = out.creep_force * moved;
    step.creep[i] = out.creep_force * (moved - step.path[i]);
    step.contact = step.contact + rail.damping[i] * (rail.slope[i] * moved - lifted);
    if (kAll) step.curving = step.curving + curving[i] * moved;
    if (output != nullptr) {
      output->normal_force_n[i] = rail.normal[i];
      output->creep_force_n[i] = out.creep_force;
      output->creepage[i] = (out.speed - r * out.spin) / Sqrt(out.speed * out.speed + v_ref * v_ref);
      output->shoe_force_n[i] = step.shoes.turning[i] * step.mobilised[i];
    }
  }
  return step;
}

/// Adds to the bodies' forces what the torques on the wheelsets react with:
///
///   M_frame += r [ mobilised (S + R + F_db) - F_t ]   over the wheelsets of the bogie, nose down positive
///
/// S, the shoes' friction, on the carbody where they hang on it. Traction F_t and dynamic brake F_db are those of the
/// driven wheelsets. Curving resistance is a force on the wheelsets' centres and reacts on no body.
template <bool kAll, class T, int kPerBogie>
void AddReactions(const BogieVehicle<kPerBogie>& w, const OuterForces<T>& outer,
                  const WheelsetStep<T, kPerBogie>& wheelsets, BodyVector<T, kPerBogie>& force) {
  const BrakeReaction reaction = w.params.brake_rigging.reaction;
  if (reaction == BrakeReaction::kNone) return;
  const double r = w.rolling.radius_m;
  for (int bogie = 0; bogie < kBogies; ++bogie) {
    T shoes(0.0), others(0.0);
    for (int i = kPerBogie * bogie; i < kPerBogie * (bogie + 1); ++i) {
      shoes = shoes + wheelsets.mobilised[i] * wheelsets.shoes.turning[i];
      if (kAll) {
        others = others +
                 (wheelsets.mobilised[i] * (outer.rolling + w.driven[i] * outer.dynamic_brake) - wheelsets.traction[i]);
      } else {
        others = others + wheelsets.mobilised[i] * outer.rolling;
      }
    }
    const int frame = kFrontFrame + bogie;
    // Places known where it is compiled: an index that is not would keep all forces in memory.
    if (reaction == BrakeReaction::kFrame) {
      force.pitch[frame] = force.pitch[frame] + r * shoes;
    } else {
      force.pitch[kCarbody] = force.pitch[kCarbody] + r * shoes;
    }
    force.pitch[frame] = force.pitch[frame] + r * others;
  }
}

/// Books the work of the torques on the wheelsets: of each with the rotation of the wheelset relative to the
/// body that it reacts on.
template <bool kAll, bool kReacts = kAll, class T, int kPerBogie>
void BookTorques(const BogieVehicle<kPerBogie>& w, const OuterForces<T>& outer,
                 const WheelsetStep<T, kPerBogie>& wheelsets, double dt, const BodyVector<T, kPerBogie>& v0,
                 const BodyVector<T, kPerBogie>& v1, VehicleWork<T>& work) {
  const BrakeReaction reaction = w.params.brake_rigging.reaction;
  // Paths at the tread [m]: relative to the rail, to the frame, to what the shoes hang on.
  std::array<T, kWheelsetsOf<kPerBogie>> of_frame = wheelsets.path, of_shoes = wheelsets.path;
  if (kReacts && reaction != BrakeReaction::kNone) {
    const double half = 0.5 * dt * w.rolling.radius_m;
    const T carbody = half * (v0.pitch[kCarbody] + v1.pitch[kCarbody]);
    for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
      const int frame = kFrontFrame + BogieOfWheelset<kPerBogie>(i);
      of_frame[i] = wheelsets.path[i] - half * (v0.pitch[frame] + v1.pitch[frame]);
      of_shoes[i] = reaction == BrakeReaction::kFrame ? of_frame[i] : wheelsets.path[i] - carbody;
    }
  }
  T shoes(0.0), bearing_path(0.0), braked_path(0.0), traction(0.0);
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    shoes = shoes + wheelsets.shoes.turning[i] * (wheelsets.mobilised[i] * of_shoes[i]);
    bearing_path = bearing_path + wheelsets.mobilised[i] * of_frame[i];
    if (kAll) {
      braked_path = braked_path + w.driven[i] * (wheelsets.mobilised[i] * of_frame[i]);
      traction = traction + wheelsets.traction[i] * of_frame[i];
    }
  }
  const auto book = [&work](Dissipation element, const T& energy) {
    work.dissipated[element] = work.dissipated[element] + energy;
  };
  book(kBrakeShoes, shoes);
  book(kRollingResistance, outer.rolling * bearing_path);
  if (kAll) {
    book(kDynamicBrake, outer.dynamic_brake * braked_path);
    book(kCurvingResistance, wheelsets.curving);
    work.traction = work.traction + traction;
  }
}

/// Books the work of a step, except the torques': force x mean rate x dt, element by element.
/// @param dissipative  forces of the dampers and of the wedges' friction
template <bool kAll, class T, int kPerBogie>
void BookWork(const BogieVehicle<kPerBogie>& w, const OuterForces<T>& outer,
              const WheelsetStep<T, kPerBogie>& wheelsets, const ElementVector<T, kPerBogie>& dissipative,
              const ElementVector<T, kPerBogie>& rate0, double dt, const BodyVector<T, kPerBogie>& v0,
              const BodyVector<T, kPerBogie>& v1, VehicleWork<T>& work) {
  const ElementVector<T, kPerBogie> rate1 = ElementsOf(w, v1);
  const auto lost = [dt](const T& f, const T& r0, const T& r1) { return 0.5 * dt * f * (r0 + r1); };
  T pads(0.0), wedges(0.0), guides(0.0), plates(0.0);
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    pads = pads + lost(dissipative.pad_x[i], rate0.pad_x[i], rate1.pad_x[i]) +
           lost(dissipative.pad_z[i], rate0.pad_z[i], rate1.pad_z[i]);
  }
  for (int i = 0; i < kQuarters; ++i) {
    wedges = wedges + lost(dissipative.wedge[i], rate0.wedge[i], rate1.wedge[i]);
    plates = plates + lost(dissipative.rim[i], rate0.rim[i], rate1.rim[i]);
  }
  for (int b = 0; b < kBogies; ++b) {
    guides = guides + lost(dissipative.guide_x[b], rate0.guide_x[b], rate1.guide_x[b]);
    plates = plates + lost(dissipative.plate_x[b], rate0.plate_x[b], rate1.plate_x[b]);
  }
  T mass_path(0.0);  // sum of mass x (v0 + v1): the grade acts on every body
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) mass_path = mass_path + w.mass_kg[i] * (v0.x[i] + v1.x[i]);

  const auto book = [&work](Dissipation element, const T& energy) {
    work.dissipated[element] = work.dissipated[element] + energy;
  };
  T creep(0.0);
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) creep = creep + wheelsets.creep[i];
  book(kWheelRailCreep, creep);
  book(kWheelRailNormal, wheelsets.contact);
  book(kAdaptorPads, pads);
  book(kFrictionWedges, wedges);
  book(kBolsterGuides, guides);
  book(kCentrePlates, plates);
  book(kAirDrag, lost(outer.drag, v0.x[kCarbody], v1.x[kCarbody]));
  if (kAll && w.params.spring_nest.damping_ns_per_m > 0.0) {
    T dampers(0.0);
    for (int i = 0; i < kQuarters; ++i) {
      dampers = dampers + lost(dissipative.nest[i], rate0.nest[i], rate1.nest[i]);
    }
    book(kNestDampers, dampers);
  }
  work.gravity = work.gravity - (0.5 * dt * kGravity) * outer.grade * mass_path;
}

template <bool kAll, bool kReacts, class T, int kPerBogie>
void StepWagonWith(const BogieVehicle<kPerBogie>& w, const Track& track, const OneSurface& surface,
                   const VehicleLoads<T>& loads, double dt, WagonState<T, kPerBogie>& s,
                   WagonOutput<T, kPerBogie>* output) {
  const BodyVector<T, kPerBogie>& v0 = s.velocity;
  BodyVector<T, kPerBogie> v1;
  Drift(v0, 0.5 * dt, s.position);

  // Forces at the middle of the step.
  const ElementVector<T, kPerBogie> deflection = ElementsOf(w, s.position);
  const ElementVector<T, kPerBogie> rate0 = ElementsOf(w, v0);
  const ElementVector<T, kPerBogie> elastic = ElasticForces(w, deflection);
  ElementVector<T, kPerBogie> dissipative = DampingForces<kAll>(w, deflection, elastic, rate0);
  const RailForces<T, kPerBogie> rail =
      kAll ? ContactForcesOnAnyTrack(w, track, s) : ContactForces<false>(w, track, surface, s);
  const OuterForces<T> outer = OuterForcesOn<kAll>(w, track, loads, s);
  BodyVector<T, kPerBogie> force;
  AddElementForces(w, elastic, force);
  AddElementForces(w, dissipative, force);
  AddOuterForces(w, outer, force);

  const WheelsetStep<T, kPerBogie> wheelsets = StepWheelsets<kAll>(w, rail, outer, force, dt, v0, v1, output);
  if (kReacts) AddReactions<kAll>(w, outer, wheelsets, force);

  // Carbody, bolsters and frames, then the wedges' friction on these.
  Kick(w, force, dt, kCarbody, kWheelset1, v0, v1);
  ElementVector<T, kPerBogie> friction{};
  friction.wedge = WedgeFrictionForces(w, deflection.wedge, rate0.wedge, ElementsOf(w, v1).wedge, dt);
  BodyVector<T, kPerBogie> friction_force;
  AddElementForces(w, friction, friction_force);
  Kick(w, friction_force, dt, kFrontBolster, kWheelset1, v1, v1);

  if (output != nullptr) output->wedge_friction_n = friction.wedge;

  Drift(v1, 0.5 * dt, s.position);

  dissipative.wedge = friction.wedge;
  BookWork<kAll>(w, outer, wheelsets, dissipative, rate0, dt, v0, v1, s.work);
  BookTorques<kAll, kReacts>(w, outer, wheelsets, dt, v0, v1, s.work);
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    s.creep_work[i] = s.creep_work[i] + wheelsets.creep[i];
    s.brake_work[i] = s.brake_work[i] + wheelsets.brake[i];
  }
  s.velocity = v1;
}

template <class T, int kPerBogie>
void StepWagon(const BogieVehicle<kPerBogie>& w, const Track& track, const VehicleLoads<T>& loads, double dt,
               WagonState<T, kPerBogie>& s, WagonOutput<T, kPerBogie>* output) {
  bool has_rare_loads = false;
  ForEachLoad([&](const LoadInfo& load,
                  const T& value) { has_rare_loads |= load.given == Given::kWhereUsed && AnyOf(value != T(0.0)); },
              loads);
  const bool all = !w.IsPlain() || has_rare_loads;
  OneSurface surface;
  const bool looks_up = all || !FindOneSurface(w, track, dt, s, surface);
  const auto step = looks_up    ? &StepWagonWith<true, true, T, kPerBogie>
                    : Reacts(w) ? &StepWagonWith<false, true, T, kPerBogie>
                                : &StepWagonWith<false, false, T, kPerBogie>;
  step(w, track, surface, loads, dt, s, output);
}

}  // namespace train_dynamics
