#pragma once

#include <vector>

/// What is recorded of each vehicle's brake beside its cylinder, where a brake computes it (else the arrays are empty).
/// Pressures are above the atmosphere. A valve's mode is 0 release, 1 apply, 2 lap, 3 emergency, 4 bailed off.
///
/// X(name, unit, meaning); from this list: the arrays below, tables of --csv, the message BrakePressures.
#define TRAIN_DYNAMICS_BRAKE_RECORD(X)                                            \
  X(pipe_pressure_pa, "Pa", "brake pipe at the vehicle")                          \
  X(auxiliary_reservoir_pa, "Pa", "auxiliary reservoir")                          \
  X(emergency_reservoir_pa, "Pa", "emergency reservoir; NaN where there is none") \
  X(valve_mode, "-", "control valve: 0 release, 1 apply, 2 lap, 3 emergency, 4 bailed off")

namespace train_dynamics {

struct BrakeRecordArrays {
#define TRAIN_DYNAMICS_FIELD(name, unit, meaning) std::vector<double> name;
  TRAIN_DYNAMICS_BRAKE_RECORD(TRAIN_DYNAMICS_FIELD)
#undef TRAIN_DYNAMICS_FIELD
  bool empty() const { return pipe_pressure_pa.empty(); }
};

/// function(name, array of `from`, array of `to`) for each field.
template <class Function, class From, class To>
void ForEachBrakeField(Function&& function, const From& from, To& to) {
#define TRAIN_DYNAMICS_FIELD(name, unit, meaning) function(#name, from.name, to.name);
  TRAIN_DYNAMICS_BRAKE_RECORD(TRAIN_DYNAMICS_FIELD)
#undef TRAIN_DYNAMICS_FIELD
}
/// function(name, array) for each field.
template <class Function, class Arrays>
void ForEachBrakeField(Function&& function, const Arrays& arrays) {
#define TRAIN_DYNAMICS_FIELD(name, unit, meaning) function(#name, arrays.name);
  TRAIN_DYNAMICS_BRAKE_RECORD(TRAIN_DYNAMICS_FIELD)
#undef TRAIN_DYNAMICS_FIELD
}

}  // namespace train_dynamics
