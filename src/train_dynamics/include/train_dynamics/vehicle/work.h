#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "train_dynamics/vehicle/field_list.h"

/// The elements of a vehicle that take energy out of it, each with its account in the energy ledger:
///   X(enumerator, name)
/// In messages: EnergyLedger.element, and the order of RankRecord.dissipated_j.
#define TRAIN_DYNAMICS_DISSIPATIONS(X)      \
  X(kWheelRailCreep, wheel_rail_creep)      \
  X(kWheelRailNormal, wheel_rail_normal)    \
  X(kAdaptorPads, adaptor_pads)             \
  X(kFrictionWedges, friction_wedges)       \
  X(kBolsterGuides, bolster_guides)         \
  X(kCentrePlates, centre_plates)           \
  X(kBrakeShoes, brake_shoes)               \
  X(kDynamicBrake, dynamic_brake)           \
  X(kRollingResistance, rolling_resistance) \
  X(kCurvingResistance, curving_resistance) \
  X(kAirDrag, air_drag)                     \
  X(kNestDampers, nest_dampers)

/// The energies of one vehicle [J], due where a record has a ledger:
///   X(name, numbers of each vehicle, meaning)
/// In messages: the arrays of this name in RankRecord.msg.
#define TRAIN_DYNAMICS_VEHICLE_ENERGIES(X)                                                  \
  X(kinetic_j, 1, "translation and rotation, >= 0")                                         \
  X(potential_j, 1, "stored in springs, contacts and the bodies' heights")                  \
  X(gravity_work_j, 1, "done on the vehicle by its weight along the grade since the start") \
  X(traction_work_j, 1, "done on the vehicle by its traction force since the start")        \
  X(dissipated_j, kDissipations, "since the start, by each element that dissipates")

namespace train_dynamics {

#define TRAIN_DYNAMICS_ENUMERATOR(enumerator, name) enumerator,
#define TRAIN_DYNAMICS_NAME(enumerator, name) #name,

enum Dissipation {
  TRAIN_DYNAMICS_DISSIPATIONS(TRAIN_DYNAMICS_ENUMERATOR)  //
  kDissipations                                           ///< their number
};

inline constexpr std::array<const char*, kDissipations> kDissipationNames = {
    TRAIN_DYNAMICS_DISSIPATIONS(TRAIN_DYNAMICS_NAME)};

#undef TRAIN_DYNAMICS_ENUMERATOR
#undef TRAIN_DYNAMICS_NAME

/// Work done on and by a vehicle since the start [J].
template <class T>
struct VehicleWork {
  std::array<T, kDissipations> dissipated{};  ///< by element, >= 0 but for the noise of wedges at rest
  T gravity{};                                ///< done on the vehicle by the grade
  T traction{};                               ///< done on the vehicle by its traction force
};

#define TRAIN_DYNAMICS_VALUE(name, numbers, meaning) Numbers<double, numbers> name{};

struct VehicleEnergy {
  TRAIN_DYNAMICS_VEHICLE_ENERGIES(TRAIN_DYNAMICS_VALUE)
};

#undef TRAIN_DYNAMICS_VALUE
#define TRAIN_DYNAMICS_CALL(name, numbers, meaning) function(FieldInfo{#name, "J", meaning, numbers}, structs.name...);

/// Calls function(FieldInfo, field, field ...) for each of a vehicle's energies; as ForEachRecordField.
template <class Function, class... Structs>
void ForEachEnergy(Function&& function, Structs&... structs) {
  TRAIN_DYNAMICS_VEHICLE_ENERGIES(TRAIN_DYNAMICS_CALL)
}

#undef TRAIN_DYNAMICS_CALL

/// The numbers of a field, one beside the other.
inline double* FirstOf(double& number) { return &number; }
inline const double* FirstOf(const double& number) { return &number; }
template <std::size_t n>
double* FirstOf(std::array<double, n>& numbers) {
  return numbers.data();
}
template <std::size_t n>
const double* FirstOf(const std::array<double, n>& numbers) {
  return numbers.data();
}

/// Gives the arrays of a message their sizes for so many vehicles.
template <class Arrays>
void ResizeEnergies(std::size_t vehicles, Arrays& arrays) {
  ForEachEnergy([vehicles](const FieldInfo& field, auto& array) { array.resize(vehicles * field.numbers); }, arrays);
}

/// Between the energies of a vehicle and its place in the arrays of a message.
template <class Arrays>
void PutEnergy(const VehicleEnergy& energy, std::size_t vehicle, Arrays& arrays) {
  ForEachEnergy(
      [vehicle](const FieldInfo& field, const auto& numbers, auto& array) {
        std::copy_n(FirstOf(numbers), field.numbers, &array[vehicle * field.numbers]);
      },
      energy, arrays);
}
template <class Arrays>
VehicleEnergy GetEnergy(std::size_t vehicle, const Arrays& arrays) {
  VehicleEnergy energy;
  ForEachEnergy(
      [vehicle](const FieldInfo& field, auto& numbers, const auto& array) {
        std::copy_n(&array[vehicle * field.numbers], field.numbers, FirstOf(numbers));
      },
      energy, arrays);
  return energy;
}

}  // namespace train_dynamics
