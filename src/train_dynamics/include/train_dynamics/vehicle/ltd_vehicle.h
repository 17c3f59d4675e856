#pragma once

#include <array>
#include <cstddef>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/vehicle/state_limits.h"
#include "train_dynamics/vehicle/vehicle_loads.h"
#include "train_dynamics/vehicle/vehicle_params.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/work.h"

namespace train_dynamics {

/// Equivalent rotational mass of a vehicle [kg] (paper Eq 8, per wheelset): m_e = n_wheelsets J / r^2, and
/// n_driven J_drive / r^2 of a locomotive's drives; for a vehicle that is one mass, the value given.
///
/// Enters the inertia only, never weight, resistance or the force of the grade.
inline double EquivalentRotationalMass(const VehicleParams& p) {
  if (p.IsOneMass()) return p.rotating_mass_kg;
  const double r2 = p.wheelset.wheel_radius_m * p.wheelset.wheel_radius_m;
  const double of_wheelsets = p.Wheelsets() * p.wheelset.pitch_inertia_kgm2 / r2;
  return p.traction ? of_wheelsets + p.traction->DrivenOf(p.Wheelsets()) * p.traction->drive_inertia_kgm2 / r2
                    : of_wheelsets;
}

/// Time integration of the one degree of freedom.
///
/// Both use the forces of paper Eq 1 once per step and are symplectic; they sample the same trajectory half a
/// step apart.
enum class LtdIntegrator {
  kLeapfrog,  ///< half drift, kick, half drift: forces at the middle of the step
  kNewmark,   ///< the paper's explicit Newmark method, beta = 0, gamma = 1/2: forces at the start of the step;
              ///< `v_mps` is its predicted velocity, i.e. that of half a step earlier
};

template <class T>
struct LtdState {
  T origin_m{};  ///< position along the track at the start; constant
  T x_m{};       ///< displacement since the start
  T v_mps{};
  VehicleWork<T> work;
};

static_assert(offsetof(LtdState<double>, x_m) == 1 * sizeof(double) &&
                  offsetof(LtdState<double>, v_mps) == 2 * sizeof(double),
              "LtdVehicle::kDigestedFields counts the numbers before x_m and v_mps");

/// Output of the last step of an LTD vehicle, for records.
template <class T>
struct LtdOutput {
  T shoe_force_n{};  ///< of all shoes, as far as it acts; backwards positive
};

/// Constants of a vehicle of conventional longitudinal train dynamics: one degree of freedom.
struct LtdVehicle {
  /// @throws std::invalid_argument when the parameters violate their rules
  LtdVehicle(const VehicleParams& params, bool with_rotational_inertia, LtdIntegrator method = LtdIntegrator::kLeapfrog,
             bool knows_adhesion_limit = false);

  template <class T>
  using State = LtdState<T>;
  template <class T>
  using Output = LtdOutput<T>;
  /// Of the state as an array of numbers: x_m and v_mps.
  static constexpr std::array<int, 2> kDigestedFields = {1, 2};

  BrakeRigging brake_rigging;
  ResistanceCoefficients propulsion_resistance;
  double weight_n;    ///< m g
  double inertia_kg;  ///< m, or m + m_e
  double per_wheel;   ///< 1 / number of wheels
  LtdIntegrator integrator;
  bool adhesion_limit;      ///< whether the rail limits the forces at the wheels
  AdhesionParams adhesion;  ///< of the rail outside of patches
  double limit_n;           ///< W M / m: mu0 times this is the most that the wheels' forces can be
};

/// One time step of paper Eq 1.
///
///   v*      = v + dt (F_front - F_rear + F_t - W grade(x)) / M
///   v_(n+1) = sgn(v*) max(|v*| - dt (F_ab + F_db + R + F_cr) / M, 0)
///
/// With `adhesion_limit` the forces at the wheels' rims, F_ab + F_db + R + F_cr together and F_t, are at most mu0(x) W
/// M / m each, so that the rail gives at most mu0(x) W: nothing slides in this model, hence no falling friction.
///
/// Brakes and resistance are set-valued at rest: the projection holds a standing vehicle exactly, on any
/// grade that the brakes can hold. Their sizes are taken at the speed of the step's start.
/// @param output  receives what the step shows; may be null
template <class T>
void StepLtd(const LtdVehicle& vehicle, const Track& track, const VehicleLoads<T>& loads, double dt, LtdState<T>& s,
             LtdOutput<T>* output = nullptr);

/// Whether a vehicle on a track has only what most have: shoes of plain rigging, no limit of adhesion, one grade.
inline bool IsPlain(const LtdVehicle& vehicle, const Track& track) {
  return vehicle.brake_rigging.is_plain && !vehicle.adhesion_limit && track.grades().IsConstant();
}
/// StepLtd; kAll = false leaves out what plain vehicles do not have, with the same bits.
template <bool kAll, class T>
void StepLtdWith(const LtdVehicle& vehicle, const Track& track, const VehicleLoads<T>& loads, double dt, LtdState<T>& s,
                 LtdOutput<T>* output);

/// Displacement of the coupler heads since the start [m]: the vehicle's own, which is rigid.
template <class T>
T CouplerHeadDisplacement(const LtdVehicle& /*vehicle*/, const LtdState<T>& s) {
  return s.x_m;
}
/// Velocity of the coupler heads [m/s].
template <class T>
T CouplerHeadVelocity(const LtdVehicle& /*vehicle*/, const LtdState<T>& s) {
  return s.v_mps;
}

template <class T>
VehicleRecord<T> RecordOf(const LtdVehicle& /*vehicle*/, const LtdState<T>& s, const LtdOutput<T>& out) {
  VehicleRecord<T> record;
  record.position_m = s.origin_m + s.x_m;
  record.speed_mps = s.v_mps;
  record.shoe_force_n = out.shoe_force_n;
  return record;
}

/// Whether the speed is one that a vehicle can have; false for anything that is not a number.
template <class T>
MaskOf<T> IsSound(const LtdVehicle& /*vehicle*/, const Track& /*track*/, const LtdState<T>& s) {
  return Abs(s.v_mps) < T(state_limits::kSpeed);
}

/// Kinetic energy [J]; the only store of energy in an LTD vehicle.
template <class T>
T KineticEnergy(const LtdVehicle& vehicle, const LtdState<T>& s) {
  return 0.5 * vehicle.inertia_kg * s.v_mps * s.v_mps;
}

// ---------------------------------------------------------------------------------------------------------------------

template <class T>
void StepLtd(const LtdVehicle& vehicle, const Track& track, const VehicleLoads<T>& loads, double dt, LtdState<T>& s,
             LtdOutput<T>* output) {
  StepLtdWith<true>(vehicle, track, loads, dt, s, output);
}

template <bool kAll, class T>
void StepLtdWith(const LtdVehicle& vehicle, const Track& track, const VehicleLoads<T>& loads, double dt, LtdState<T>& s,
                 LtdOutput<T>* output) {
  const T v0 = s.v_mps;
  const double drift = vehicle.integrator == LtdIntegrator::kLeapfrog ? 0.5 * dt : 0.0;
  s.x_m = s.x_m + drift * v0;

  const T grade = kAll ? GradeUnder(track, s.origin_m + s.x_m) : T(track.grades().First());
  const T gravity = -vehicle.weight_n * grade;
  T shoes = kAll ? ShoeForce(vehicle.brake_rigging, loads.cylinder_pressure_pa, v0)
                 : PlainShoeForce(vehicle.brake_rigging, loads.cylinder_pressure_pa, v0);
  T rolling = RollingResistance(vehicle.propulsion_resistance, vehicle.weight_n, v0);
  if (kAll && vehicle.brake_rigging.params.shoe_friction.icy) {
    shoes =
        IcyFactor(*vehicle.brake_rigging.params.shoe_friction.icy, vehicle.per_wheel * s.work.dissipated[kBrakeShoes]) *
        shoes;
  }
  if (kAll) rolling = Max(rolling, loads.breakaway_resistance_n);
  T dynamic_brake = loads.dynamic_brake_n, traction = loads.traction_n;
  const T curving = loads.curving_resistance_n;  // at the flanges: it takes nothing of the adhesion
  if (kAll && vehicle.adhesion_limit) {
    const T most = vehicle.limit_n * RailSurfaceUnder(track, s.origin_m + s.x_m, vehicle.adhesion).friction;
    const T share = Min(T(1.0), most / Max(T(1e-300), shoes + dynamic_brake + rolling));
    shoes = share * shoes;
    rolling = share * rolling;
    dynamic_brake = share * dynamic_brake;
    traction = Clamp(traction, -most, most);
  }
  const T drag = AirDrag(vehicle.propulsion_resistance, vehicle.weight_n, v0);
  const T retarding = shoes + dynamic_brake + rolling + curving + drag;

  const double per_inertia = dt / vehicle.inertia_kg;
  const T free = v0 + per_inertia * (loads.front_coupler_n - loads.rear_coupler_n + traction + gravity);
  const T v1 = CopySign(Max(T(0.0), Abs(free) - per_inertia * retarding), free);
  s.v_mps = v1;
  s.x_m = s.x_m + (dt - drift) * v1;

  const T path = 0.5 * dt * (v0 + v1);   // force x path = exact change of kinetic energy
  T mobilised = CopySign(T(1.0), free);  // -1 ... 1: the part of the retarding forces that acts, against `free`
  const MaskOf<T> comes_to_rest = v1 == T(0.0);
  if (AnyOf(comes_to_rest)) {
    mobilised = Select(comes_to_rest, free / Max(T(1e-300), per_inertia * retarding), mobilised);
  }
  const T mobilised_path = mobilised * path;
  if (output != nullptr) output->shoe_force_n = shoes * mobilised;
  VehicleWork<T>& work = s.work;
  work.gravity = work.gravity + gravity * path;
  const auto book = [&](Dissipation element, const T& force) {
    work.dissipated[element] = work.dissipated[element] + force * mobilised_path;
  };
  book(kBrakeShoes, shoes);
  book(kRollingResistance, rolling);
  book(kAirDrag, drag);
  const T zero = T(0.0);  // what few vehicles meet is booked where it is met
  if (AnyOf(traction != zero)) work.traction = work.traction + traction * path;
  if (AnyOf(dynamic_brake != zero)) book(kDynamicBrake, dynamic_brake);
  if (AnyOf(curving != zero)) book(kCurvingResistance, curving);
}

}  // namespace train_dynamics
