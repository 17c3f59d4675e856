#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "train_dynamics/vehicle/vehicle_model.h"

/// The lists of the data exchanged between a vehicle and the master of its train. Each list exists once, as a macro
/// LIST(X) that names its fields; the structs that hold them, and the code that fills, sends, checks, stores and
/// compares them, are made from it.
namespace train_dynamics {

/// Where a recorded quantity has a value; elsewhere it is NaN.
enum class Presence {
  kAlways,
  kAfterStep,      ///< not at time 0, where nothing has acted on the vehicle yet
  kAfterStepTwoD,  ///< of the 2D model only, and not at time 0
};

/// @param has_moved  by one step at least since it was made, or taken from a snapshot
constexpr bool IsComputed(Presence presence, VehicleModel model, bool has_moved) {
  return presence == Presence::kAlways ||
         (has_moved && (presence == Presence::kAfterStep || model == VehicleModel::kTwoD));
}

/// Whether a load is part of every exchange between master and vehicles.
enum class Given {
  kAlways,
  kWhereUsed,  ///< an empty array means zero on all vehicles
};

/// A field of a list, as people read it.
struct FieldInfo {
  const char* name;  ///< of the field in every struct and message
  const char* unit;
  const char* meaning;
  int numbers;  ///< of each vehicle; those of one vehicle are adjacent
};

/// `n` numbers, or one that needs no index.
template <class T, int n>
using Numbers = std::conditional_t<n == 1, T, std::array<T, static_cast<std::size_t>(n)>>;

/// NaN for each of them.
template <class T, int n>
Numbers<T, n> NotComputed() {
  const T nan(std::numeric_limits<double>::quiet_NaN());
  if constexpr (n == 1) {
    return nan;
  } else {
    Numbers<T, n> all;
    all.fill(nan);
    return all;
  }
}

/// Whether a state over the scalar type T can be treated as a row of T: copied as bytes, with nothing in it that is
/// not a T (a member of any other type, or padding, would not grow with T).
template <template <class> class State>
inline constexpr bool kIsRowOfNumbers =
    std::is_trivially_copyable_v<State<double>>&& std::is_standard_layout_v<State<double>> &&
    sizeof(State<double>) % sizeof(double) == 0 &&
    sizeof(State<double>) / sizeof(double) == sizeof(State<float>) / sizeof(float) &&
    sizeof(State<double>) == 2 * sizeof(State<float>);

}  // namespace train_dynamics
