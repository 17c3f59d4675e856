#pragma once

#include <array>
#include <cstddef>

#include "train_dynamics/track/track.h"
#include "train_dynamics/vehicle/state_limits.h"
#include "train_dynamics/vehicle/vehicle_loads.h"
#include "train_dynamics/vehicle/vehicle_params.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/wheelset_slip.h"
#include "train_dynamics/vehicle/work.h"

/// The 2D vehicle: a carbody on two bogies, rigid bodies in the longitudinal-vertical plane, each with x, z and
/// pitch. The paper's wagon has two wheelsets per bogie: nine bodies, 27 degrees of freedom. A locomotive on
/// three-axle bogies has three: eleven bodies, 33 degrees of freedom.
///
///                 ______________________________________________
///     coupler o--|                 carbody (0)                  |--o coupler
///                |__________________________________________CG__|
///                   rim v v rim                    v v            centre plates
///     <- rear      [bolster 2]                 [bolster 1]        front ->  x
///                   nests, wedges                                           z up
///                [  bogie frame 4  ]        [  bogie frame 3  ]         pitch: nose down positive
///                 pad          pad           pad          pad
///                (wheelset 8) (7)           (6)          (5)
///     =================================================================== rail
///
/// With three wheelsets per bogie they are 5, 6, 7 in front and 8, 9, 10 behind.
///
/// Coordinates are displacements from the state in which springs are unloaded and wheels just touch; small
/// angles: the point at (dx, dz) from a CG moves by u_x = x + dz theta, u_z = z - dx theta.
namespace train_dynamics {

enum Body {
  kCarbody,
  kFrontBolster,
  kRearBolster,
  kFrontFrame,
  kRearFrame,
  kWheelset1,
  kWheelset2,
  kWheelset3,
  kWheelset4,
  kBodies  ///< their number with two wheelsets per bogie
};
inline constexpr int kWheelsets = 4;  ///< with two wheelsets per bogie
inline constexpr int kBogies = 2;
inline constexpr int kQuarters = 4;  ///< spring nests, pairs of wedges, rims: 2 bogie + end, end 0 = front

/// Wheelsets and bodies of a vehicle with `kPerBogie` wheelsets per bogie.
template <int kPerBogie>
inline constexpr int kWheelsetsOf = kBogies* kPerBogie;
template <int kPerBogie>
inline constexpr int kBodiesOf = kWheelset1 + kWheelsetsOf<kPerBogie>;
static_assert(kWheelsetsOf<2> == kWheelsets && kBodiesOf<2> == kBodies);

inline constexpr std::array<const char*, kBodiesOf<3>> kBodyNames = {
    "carbody",    "front bolster", "rear bolster", "front bogie frame", "rear bogie frame", "wheelset 1",
    "wheelset 2", "wheelset 3",    "wheelset 4",   "wheelset 5",        "wheelset 6"};

/// One number per degree of freedom: positions, velocities or forces of the bodies.
template <class T, int kPerBogie = 2>
struct BodyVector {
  std::array<T, kBodiesOf<kPerBogie>> x{}, z{}, pitch{};
};

/// One number per element: deflections if made of positions, rates if made of velocities, forces.
///
/// Vertical elements count compression positive, longitudinal ones the forward displacement of the upper body
/// over the lower one (pads: of the wheelset over the frame). A force is positive where it resists a positive
/// deflection.
template <class T, int kPerBogie = 2>
struct ElementVector {
  std::array<T, kWheelsetsOf<kPerBogie>> pad_x{}, pad_z{};  ///< by wheelset
  std::array<T, kQuarters> nest{}, wedge{}, rim{};
  std::array<T, kBogies> guide_x{}, plate_x{};
};

template <class T, int kPerBogie = 2>
struct WagonState {
  T origin_m{};  ///< position of the wagon's centre along the track at the start; constant
  BodyVector<T, kPerBogie> position;
  BodyVector<T, kPerBogie> velocity;
  VehicleWork<T> work;
  /// By wheelset, both wheels, since the start [J]: lost in creep (their sum is the account of kWheelRailCreep); of the
  /// longitudinal force on the rail, positive where it brakes.
  std::array<T, kWheelsetsOf<kPerBogie>> creep_work{}, brake_work{};
};

static_assert(offsetof(WagonState<double>, position) == sizeof(double) &&
                  offsetof(WagonState<double>, velocity) ==
                      offsetof(WagonState<double>, position) + 3 * kBodies * sizeof(double),
              "Wagon::kDigestedFields counts the numbers before positions and velocities");

/// Output of the last step of a wagon, for records.
template <class T, int kPerBogie = 2>
struct WagonOutput {
  using PerWheelset = std::array<T, kWheelsetsOf<kPerBogie>>;
  PerWheelset normal_force_n{};                 ///< of both wheels
  PerWheelset creepage{};                       ///< (v - omega r) / sqrt(v^2 + v0^2)
  PerWheelset creep_force_n{};                  ///< of both wheels, backwards positive
  PerWheelset shoe_force_n{};                   ///< tangential, at the tread, backwards positive while turning
  std::array<T, kQuarters> wedge_friction_n{};  ///< of the left and right wedge together, up on the bolster
};

/// What is constant in a 2D vehicle with `kPerBogie` wheelsets per bogie.
template <int kPerBogie>
struct BogieVehicle {
  static constexpr int kWheelsets = kWheelsetsOf<kPerBogie>, kBodies = kBodiesOf<kPerBogie>;

  /// @throws std::invalid_argument when the parameters violate their rules, are those of another number of
  ///         wheelsets, or the wedges of a bogie are coupled too strongly for the time step
  explicit BogieVehicle(const VehicleParams& params);

  template <class T>
  using State = WagonState<T, kPerBogie>;
  template <class T>
  using Output = WagonOutput<T, kPerBogie>;
  /// Of the state as an array of numbers: for positions, then velocities, x, z and pitch of each body.
  static constexpr std::array<int, 6 * kBodies> kDigestedFields = [] {
    std::array<int, 6 * kBodies> fields{};
    for (int i = 0; i < 6 * kBodies; ++i) {
      const int motion = i / (3 * kBodies), body = i / 3 % kBodies, axis = i % 3;
      fields[i] = 1 + (3 * motion + axis) * kBodies + body;  // behind origin_m
    }
    return fields;
  }();
  /// Of the state as an array of numbers: the carbody's speed, the first wheelset's rotation; the others' follow.
  static constexpr int kSpeed = 1 + 3 * kBodies + kCarbody, kFirstSpin = 1 + 5 * kBodies + kWheelset1;
  /// Of the first wheelset: distance run, rotation [rad], speed; energy lost in creep, work on the rail.
  static constexpr int kFirstWay = 1 + kWheelset1, kFirstTurn = 1 + 2 * kBodies + kWheelset1,
                       kFirstSpeed = 1 + 3 * kBodies + kWheelset1,
                       kFirstCreep = 1 + 6 * kBodies + sizeof(VehicleWork<double>) / sizeof(double),
                       kFirstBrake = kFirstCreep + kWheelsets;
  /// Of the output as an array of numbers: the first wheelset's creep force; normal forces come first of all.
  static constexpr int kFirstCreepForce = 2 * kWheelsets;

  VehicleParams params;
  FrictionWedge wedge;  ///< without springs, hence without forces, where there are no wedges
  std::array<double, kBodies> mass_kg, inv_mass_per_kg;
  std::array<double, kBodies> inertia_kgm2, inv_inertia_per_kgm2;
  std::array<double, kWheelsets> wheelset_offset_m;  ///< from the wagon's centre, forward positive
  std::array<double, kQuarters> nest_offset_m, wedge_offset_m, rim_offset_m;  ///< from the bolster's centre
  std::array<double, kBogies> bogie_offset_m;                                 ///< from the wagon's centre
  double pad_frame_arm_m;                           ///< height of the pads over the frame's CG
  double guide_bolster_arm_m, guide_frame_arm_m;    ///< heights of the guide over the CGs
  double plate_carbody_arm_m, plate_bolster_arm_m;  ///< heights of the centre plate over the CGs
  double coupler_arm_m;                             ///< height of the couplers over the carbody's CG
  double weight_n;
  BrakeRigging rigging;
  ResistanceCoefficients resistance;
  double creep_stiffness;  ///< see CreepStiffness
  RollingInertia rolling;  ///< of the first wheelset
  RollingInertias<kWheelsets> rolling_of_each;
  bool some_driven;                       ///< some wheelsets have drives and others have not
  std::array<double, kWheelsets> driven;  ///< 1 or 0; 1 for all of a vehicle without traction
  double driven_share;                    ///< of one of them in traction and dynamic brake

  /// Whether no nest has a damper, no wheelset a drive, and the shoes are plain, as in the paper's wagon.
  bool IsPlain() const { return params.spring_nest.damping_ns_per_m == 0.0 && !params.traction && rigging.is_plain; }
};

using Wagon = BogieVehicle<2>;
using SixAxleVehicle = BogieVehicle<3>;

/// Calls use(vehicle) with the 2D model of a vehicle, of whichever number of wheelsets.
template <class Use>
auto WithBogieVehicle(const VehicleParams& params, const Use& use) {
  return params.wheelsets_per_bogie == 3 ? use(SixAxleVehicle(params)) : use(Wagon(params));
}

/// The bogie (0 front, 1 rear) of a wheelset, and of a quarter.
template <int kPerBogie>
constexpr int BogieOfWheelset(int wheelset) {
  return wheelset / kPerBogie;
}
constexpr int BogieOfQuarter(int quarter) { return quarter / 2; }

/// Deflections of all elements from the bodies' positions; rates from their velocities. Linear.
template <class T, int kPerBogie>
ElementVector<T, kPerBogie> ElementsOf(const BogieVehicle<kPerBogie>& w, const BodyVector<T, kPerBogie>& q) {
  ElementVector<T, kPerBogie> e;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int frame = kFrontFrame + BogieOfWheelset<kPerBogie>(i), wheelset = kWheelset1 + i;
    const double dx = w.wheelset_offset_m[i] - w.bogie_offset_m[BogieOfWheelset<kPerBogie>(i)];
    e.pad_x[i] = q.x[wheelset] - (q.x[frame] + w.pad_frame_arm_m * q.pitch[frame]);
    e.pad_z[i] = q.z[wheelset] - (q.z[frame] - dx * q.pitch[frame]);
  }
  for (int i = 0; i < kQuarters; ++i) {
    const int frame = kFrontFrame + BogieOfQuarter(i), bolster = kFrontBolster + BogieOfQuarter(i);
    const T lift = q.z[frame] - q.z[bolster];
    const T turn = q.pitch[frame] - q.pitch[bolster];
    e.nest[i] = lift - w.nest_offset_m[i] * turn;
    e.wedge[i] = lift - w.wedge_offset_m[i] * turn;
    e.rim[i] = (q.z[bolster] - w.rim_offset_m[i] * q.pitch[bolster]) -
               (q.z[kCarbody] - (w.bogie_offset_m[BogieOfQuarter(i)] + w.rim_offset_m[i]) * q.pitch[kCarbody]);
  }
  for (int b = 0; b < kBogies; ++b) {
    const int frame = kFrontFrame + b, bolster = kFrontBolster + b;
    e.guide_x[b] =
        (q.x[bolster] + w.guide_bolster_arm_m * q.pitch[bolster]) - (q.x[frame] + w.guide_frame_arm_m * q.pitch[frame]);
    e.plate_x[b] = (q.x[kCarbody] + w.plate_carbody_arm_m * q.pitch[kCarbody]) -
                   (q.x[bolster] + w.plate_bolster_arm_m * q.pitch[bolster]);
  }
  return e;
}

/// Adds to the bodies' forces what the elements exert on them: the transpose of ElementsOf, so that the work
/// of the bodies' forces is minus the work of the elements' forces in every motion.
template <class T, int kPerBogie>
void AddElementForces(const BogieVehicle<kPerBogie>& w, const ElementVector<T, kPerBogie>& force,
                      BodyVector<T, kPerBogie>& f) {
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int frame = kFrontFrame + BogieOfWheelset<kPerBogie>(i), wheelset = kWheelset1 + i;
    const double dx = w.wheelset_offset_m[i] - w.bogie_offset_m[BogieOfWheelset<kPerBogie>(i)];
    f.x[wheelset] = f.x[wheelset] - force.pad_x[i];
    f.z[wheelset] = f.z[wheelset] - force.pad_z[i];
    f.x[frame] = f.x[frame] + force.pad_x[i];
    f.z[frame] = f.z[frame] + force.pad_z[i];
    f.pitch[frame] = f.pitch[frame] + (w.pad_frame_arm_m * force.pad_x[i] - dx * force.pad_z[i]);
  }
  for (int i = 0; i < kQuarters; ++i) {
    const int frame = kFrontFrame + BogieOfQuarter(i), bolster = kFrontBolster + BogieOfQuarter(i);
    const T apart = force.nest[i] + force.wedge[i];
    const T moment = w.nest_offset_m[i] * force.nest[i] + w.wedge_offset_m[i] * force.wedge[i];
    f.z[frame] = f.z[frame] - apart;
    f.pitch[frame] = f.pitch[frame] + moment;
    f.z[bolster] = f.z[bolster] + (apart - force.rim[i]);
    f.pitch[bolster] = f.pitch[bolster] + (w.rim_offset_m[i] * force.rim[i] - moment);
    f.z[kCarbody] = f.z[kCarbody] + force.rim[i];
    f.pitch[kCarbody] = f.pitch[kCarbody] - (w.bogie_offset_m[BogieOfQuarter(i)] + w.rim_offset_m[i]) * force.rim[i];
  }
  for (int b = 0; b < kBogies; ++b) {
    const int frame = kFrontFrame + b, bolster = kFrontBolster + b;
    f.x[bolster] = f.x[bolster] + (force.plate_x[b] - force.guide_x[b]);
    f.pitch[bolster] =
        f.pitch[bolster] + (w.plate_bolster_arm_m * force.plate_x[b] - w.guide_bolster_arm_m * force.guide_x[b]);
    f.x[frame] = f.x[frame] + force.guide_x[b];
    f.pitch[frame] = f.pitch[frame] + w.guide_frame_arm_m * force.guide_x[b];
    f.x[kCarbody] = f.x[kCarbody] - force.plate_x[b];
    f.pitch[kCarbody] = f.pitch[kCarbody] - w.plate_carbody_arm_m * force.plate_x[b];
  }
}

/// Forces that the elements would exert without any dissipation, as functions of their deflections.
template <class T, int kPerBogie>
ElementVector<T, kPerBogie> ElasticForces(const BogieVehicle<kPerBogie>& w,
                                          const ElementVector<T, kPerBogie>& deflection) {
  const VehicleParams& p = w.params;
  ElementVector<T, kPerBogie> force;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    force.pad_x[i] = 2.0 * p.adaptor_pad.stiffness_n_per_m * deflection.pad_x[i];
    force.pad_z[i] = 2.0 * p.adaptor_pad.stiffness_n_per_m * deflection.pad_z[i];
  }
  for (int i = 0; i < kQuarters; ++i) {  // each quarter twice: left and right
    force.nest[i] = 2.0 * SpringNestForce(p.spring_nest, deflection.nest[i]);
    force.rim[i] = RimForce(p.centre_plate, deflection.rim[i], T(0.0));
  }
  for (int i = 0; i < kQuarters; ++i) {
    force.wedge[i] = (2.0 * w.wedge.kappa) * WedgeSpringForce(w.wedge.params, w.wedge.kappa * deflection.wedge[i]);
  }
  for (int b = 0; b < kBogies; ++b) {
    force.guide_x[b] = p.bolster_guide.stiffness_n_per_m * deflection.guide_x[b];
    force.plate_x[b] = p.centre_plate.stiffness_n_per_m * deflection.plate_x[b];
  }
  return force;
}

/// Forces of the linear dampers; one-sided where the contact is (its whole force stays >= 0).
/// @tparam kAll  see StepWagonWith
template <bool kAll, class T, int kPerBogie>
ElementVector<T, kPerBogie> DampingForces(const BogieVehicle<kPerBogie>& w,
                                          const ElementVector<T, kPerBogie>& deflection,
                                          const ElementVector<T, kPerBogie>& elastic,
                                          const ElementVector<T, kPerBogie>& rate) {
  const VehicleParams& p = w.params;
  ElementVector<T, kPerBogie> force;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    force.pad_x[i] = 2.0 * p.adaptor_pad.damping_ns_per_m * rate.pad_x[i];
    force.pad_z[i] = 2.0 * p.adaptor_pad.damping_ns_per_m * rate.pad_z[i];
  }
  for (int i = 0; i < kQuarters; ++i) {
    force.rim[i] = RimForce(p.centre_plate, deflection.rim[i], rate.rim[i]) - elastic.rim[i];
  }
  if (kAll && p.spring_nest.damping_ns_per_m > 0.0) {
    for (int i = 0; i < kQuarters; ++i) force.nest[i] = 2.0 * p.spring_nest.damping_ns_per_m * rate.nest[i];
  }
  for (int b = 0; b < kBogies; ++b) {
    force.guide_x[b] = p.bolster_guide.damping_ns_per_m * rate.guide_x[b];
    force.plate_x[b] = p.centre_plate.damping_ns_per_m * rate.plate_x[b];
  }
  return force;
}

/// Wagon at rest on level rail under its own weight, wedges without friction, moving at `speed_mps` with
/// rolling wheels.
template <int kPerBogie>
WagonState<double, kPerBogie> StaticEquilibrium(const BogieVehicle<kPerBogie>& wagon, double origin_m,
                                                double speed_mps);

/// Displacement of the coupler heads since the start, or their velocity [m, m/s]: x + (h_coupler - h_CG)
/// theta.
template <class T, int kPerBogie>
T CouplerHead(const BogieVehicle<kPerBogie>& wagon, const BodyVector<T, kPerBogie>& carbody_motion) {
  return carbody_motion.x[kCarbody] + wagon.coupler_arm_m * carbody_motion.pitch[kCarbody];
}

template <class T, int kPerBogie>
T CouplerHeadDisplacement(const BogieVehicle<kPerBogie>& wagon, const WagonState<T, kPerBogie>& s) {
  return CouplerHead(wagon, s.position);
}
template <class T, int kPerBogie>
T CouplerHeadVelocity(const BogieVehicle<kPerBogie>& wagon, const WagonState<T, kPerBogie>& s) {
  return CouplerHead(wagon, s.velocity);
}

template <class T, int kPerBogie>
VehicleRecord<T> RecordOf(const BogieVehicle<kPerBogie>& /*wagon*/, const WagonState<T, kPerBogie>& s,
                          const WagonOutput<T, kPerBogie>& out) {
  T shoes(0.0), wheels(0.0), creepage(0.0);
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    shoes = shoes + out.shoe_force_n[i];
    wheels = wheels + out.creep_force_n[i];
    creepage = Select(Abs(out.creepage[i]) <= Abs(creepage), creepage, out.creepage[i]);  // keeps NaN
  }
  VehicleRecord<T> record;
  record.position_m = s.origin_m + s.position.x[kCarbody];
  record.speed_mps = s.velocity.x[kCarbody];
  record.shoe_force_n = shoes;
  record.wheel_force_n = wheels;
  record.creepage = creepage;
  return record;
}

/// Height and pitch of each body over the rail under it, from the state in which springs are unloaded.
template <class T, int kPerBogie = 2>
struct OverRail {
  std::array<T, kBodiesOf<kPerBogie>> z, pitch;
};

/// The rail under a wheelset is at its wheels; the rail under a bogie (its bolster and frame) is the line between those
/// under its outer wheelsets, the rail under the carbody the line between the middles of those under its bogies. A
/// pitch counts from the pitch of that line; that of a wheelset is its rotation and has no reference.
template <class T, int kPerBogie>
OverRail<T, kPerBogie> OverRailOf(const BogieVehicle<kPerBogie>& w, const Track& track,
                                  const WagonState<T, kPerBogie>& s) {
  OverRail<T, kPerBogie> over{s.position.z, s.position.pitch};
  if (!track.has_dips) return over;
  std::array<T, kWheelsetsOf<kPerBogie>> rail;
  for (int i = 0; i < kWheelsetsOf<kPerBogie>; ++i) {
    const int b = kWheelset1 + i;
    const T at = s.origin_m + (s.position.x[b] + w.wheelset_offset_m[i]);
    rail[i] = RailHeightUnder(track, at).height;
    over.z[b] = over.z[b] - rail[i];
  }
  std::array<T, kBogies> middle;
  for (int b = 0; b < kBogies; ++b) {
    const int first = kPerBogie * b, last = first + kPerBogie - 1;
    const T front = rail[first], rear = rail[last];
    const T pitch = (rear - front) * (1.0 / (w.wheelset_offset_m[first] - w.wheelset_offset_m[last]));
    middle[b] = 0.5 * (front + rear);
    for (const int body : {kFrontBolster + b, kFrontFrame + b}) {
      over.z[body] = over.z[body] - middle[b];
      over.pitch[body] = over.pitch[body] - pitch;
    }
  }
  over.z[kCarbody] = over.z[kCarbody] - 0.5 * (middle[0] + middle[1]);
  over.pitch[kCarbody] =
      over.pitch[kCarbody] - (middle[1] - middle[0]) * (1.0 / (w.bogie_offset_m[0] - w.bogie_offset_m[1]));
  return over;
}

/// Whether every body's position and speed are within state_limits; false for NaN. Heights and pitches count from the
/// rail, so that a train in a deep, gentle valley is sound.
template <class T, int kPerBogie>
MaskOf<T> IsSound(const BogieVehicle<kPerBogie>& w, const Track& track, const WagonState<T, kPerBogie>& s) {
  const OverRail<T, kPerBogie> over = OverRailOf(w, track, s);
  MaskOf<T> sound = Abs(s.velocity.x[kCarbody]) < T(state_limits::kSpeed);
  for (int b = 0; b < kBodiesOf<kPerBogie>; ++b) {
    sound = sound & (Abs(s.velocity.x[b]) < T(state_limits::kSpeed)) &
            (Abs(s.velocity.z[b]) < T(state_limits::kSpeed)) & (Abs(over.z[b]) < T(state_limits::kMovement)) &
            (b < kWheelset1 ? Abs(over.pitch[b]) < T(state_limits::kPitch)
                            : Abs(s.velocity.pitch[b]) < T(state_limits::kRotation));
  }
  return sound;
}

/// Kinetic energy of the bodies, rotation included [J].
template <int kPerBogie>
double KineticEnergy(const BogieVehicle<kPerBogie>& wagon, const WagonState<double, kPerBogie>& state);

/// Elastic energy of all elements and contacts plus the bodies' weight times their height z [J].
template <int kPerBogie>
double PotentialEnergy(const BogieVehicle<kPerBogie>& wagon, const Track& track,
                       const WagonState<double, kPerBogie>& state);

}  // namespace train_dynamics
