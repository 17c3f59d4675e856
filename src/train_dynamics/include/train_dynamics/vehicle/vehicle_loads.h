#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "train_dynamics/vehicle/field_list.h"

/// The loads on a vehicle that do not follow from its own equations, except its couplers:
///   X(name, unit, given, meaning)
/// In messages: the arrays of this name in Step.srv. A load that is given only where it is used costs a train without
/// it an empty array.
#define TRAIN_DYNAMICS_VEHICLE_LOADS(X)                                                  \
  X(cylinder_pressure_pa, "Pa", kAlways, "of the air brake; above the atmosphere, >= 0") \
  X(traction_n, "N", kWhereUsed, "at the wheel rims; forward positive")                  \
  X(dynamic_brake_n, "N", kWhereUsed, "at the wheel rims, >= 0; opposes the rotation")   \
  X(curving_resistance_n, "N", kWhereUsed, ">= 0; opposes the motion")                   \
  X(breakaway_resistance_n, "N", kWhereUsed, ">= 0; of bearings at least, while starting")

namespace train_dynamics {

inline constexpr int kMostWheelsets = 6;  ///< of a vehicle

#define TRAIN_DYNAMICS_VALUE(name, unit, given, meaning) T name{};
#define TRAIN_DYNAMICS_ARRAY(name, unit, given, meaning) std::vector<double> name;
#define TRAIN_DYNAMICS_POINTER(name, unit, given, meaning) const double* name = nullptr;

/// The loads on one vehicle, held over an exchange interval.
///
/// Paper Eq 1: F_c1 + F_c2 + F_t + F_db + F_ab + F_cr; propulsion resistance and gravity are the vehicle's
/// own.
template <class T>
struct VehicleLoads {
  T front_coupler_n{};  ///< tension positive: pulls forward
  T rear_coupler_n{};   ///< tension positive: pulls backward
  TRAIN_DYNAMICS_VEHICLE_LOADS(TRAIN_DYNAMICS_VALUE)
  /// Of the cylinder of each wheelset [Pa], where the vehicle's wheel-slide protection has them apart; null:
  /// cylinder_pressure_pa on all.
  const std::array<T, kMostWheelsets>* wheelset_pressure_pa = nullptr;
  /// Share of the traction that slip control leaves each wheelset [-]; null: all of it.
  const std::array<T, kMostWheelsets>* traction_share = nullptr;
};

/// Those on a row of vehicles.
struct LoadArrays {
  /// [vehicles + 1]: [i] before, [i + 1] behind vehicle i; tension positive; 0 where there is no connection
  std::vector<double> coupler_force_n;
  TRAIN_DYNAMICS_VEHICLE_LOADS(TRAIN_DYNAMICS_ARRAY)  ///< [vehicle], or empty: see Given
};

/// From the place of one vehicle on; null for an array that is empty.
struct LoadPlaces {
  const double* front_coupler_n = nullptr;
  const double* rear_coupler_n = nullptr;
  TRAIN_DYNAMICS_VEHICLE_LOADS(TRAIN_DYNAMICS_POINTER)
  /// VehicleLoads::wheelset_pressure_pa, as [pack][kMostWheelsets][lane of the kernels]; not from the master
  const double* wheelset_pressure_pa = nullptr;
  const double* traction_share = nullptr;  ///< likewise
};

#undef TRAIN_DYNAMICS_VALUE
#undef TRAIN_DYNAMICS_ARRAY
#undef TRAIN_DYNAMICS_POINTER

struct LoadInfo {
  const char* name;
  const char* unit;
  const char* meaning;
  Given given;
};

#define TRAIN_DYNAMICS_CALL(name, unit, given, meaning) \
  function(LoadInfo{#name, unit, meaning, Given::given}, structs.name...);

/// Calls function(LoadInfo, field, field ...) for each load but the couplers'; as ForEachRecordField.
template <class Function, class... Structs>
void ForEachLoad(Function&& function, Structs&... structs) {
  TRAIN_DYNAMICS_VEHICLE_LOADS(TRAIN_DYNAMICS_CALL)
}

#undef TRAIN_DYNAMICS_CALL

/// Gives the arrays of a struct or message their sizes for so many vehicles.
/// @param with_all  those, too, that are given only where they are used
template <class Arrays>
void ResizeLoads(std::size_t vehicles, bool with_all, Arrays& arrays) {
  arrays.coupler_force_n.resize(vehicles + 1);
  ForEachLoad(
      [=](const LoadInfo& load, auto& array) { array.resize(with_all || load.given == Given::kAlways ? vehicles : 0); },
      arrays);
}

/// Copies the loads on the vehicles [first, first + count) to the arrays of a struct or message; those that are not
/// used become empty.
template <class From, class To>
void CopyLoads(const From& from, std::size_t first, std::size_t count, To& to) {
  const auto copy = [](const auto& whole, std::size_t begin, std::size_t numbers, auto& part) {
    const auto at = whole.begin() + static_cast<std::ptrdiff_t>(begin);
    part.assign(at, at + static_cast<std::ptrdiff_t>(numbers));
  };
  copy(from.coupler_force_n, first, count + 1, to.coupler_force_n);
  ForEachLoad([&](const LoadInfo&, const auto& whole,
                  auto& part) { whole.empty() ? part.clear() : copy(whole, first, count, part); },
              from, to);
}

/// Whether two structs or messages hold the same loads.
template <class A, class B>
bool AreSameLoads(const A& a, const B& b) {
  bool same = a.coupler_force_n == b.coupler_force_n;
  ForEachLoad([&same](const LoadInfo&, const auto& one, const auto& other) { same = same && one == other; }, a, b);
  return same;
}

/// The places of vehicle `at`.
inline LoadPlaces PlacesOf(const LoadArrays& arrays, std::size_t at) {
  LoadPlaces places;
  places.front_coupler_n = arrays.coupler_force_n.data() + at;
  places.rear_coupler_n = arrays.coupler_force_n.data() + at + 1;
  ForEachLoad(
      [at](const LoadInfo&, const auto& array, auto& place) { place = array.empty() ? nullptr : array.data() + at; },
      arrays, places);
  return places;
}

/// The places of the vehicles [at, at + count); null, too, for a load that few trains have and that acts on none of
/// these: they are stepped faster without it.
inline LoadPlaces PlacesOfThoseThatAct(const LoadArrays& arrays, std::size_t at, std::size_t count) {
  LoadPlaces places = PlacesOf(arrays, at);
  ForEachLoad(
      [count](const LoadInfo& load, const double*& place) {
        if (load.given == Given::kAlways || place == nullptr) return;
        if (std::all_of(place, place + count, [](double value) { return value == 0.0; })) place = nullptr;
      },
      places);
  return places;
}

}  // namespace train_dynamics
