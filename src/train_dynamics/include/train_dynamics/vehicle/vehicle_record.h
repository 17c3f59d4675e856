#pragma once

#include <vector>

#include "train_dynamics/vehicle/field_list.h"

/// What a vehicle replies to its master in every exchange:
///   X(name, numbers of each vehicle, unit, presence, meaning)
/// In messages: the arrays of this name in Step.srv and Configure.srv.
#define TRAIN_DYNAMICS_VEHICLE_REPLY(X)                                                             \
  X(head_displacement_m, 1, "m", kAlways, "of the coupler heads since the start; forward positive") \
  X(head_velocity_mps, 1, "m/s", kAlways, "of the coupler heads; forward positive")

/// What a record holds of every vehicle:
///   X(name, numbers of each vehicle, unit, presence, meaning)
/// In messages: the arrays of this name in RankRecord.msg and TrainState.msg. In tables: the columns of
/// vehicles.csv. A model leaves at NaN what it does not compute.
#define TRAIN_DYNAMICS_VEHICLE_RECORD(X)                                                                \
  X(position_m, 1, "m", kAlways, "distance of the vehicle's centre along the track")                    \
  X(speed_mps, 1, "m/s", kAlways, "of the carbody; forward positive")                                   \
  X(shoe_force_n, 1, "N", kAfterStep, "brake shoes on the wheel treads, sum; backwards positive")       \
  X(wheel_force_n, 1, "N", kAfterStepTwoD, "rail on the wheels, longitudinal, sum; backwards positive") \
  X(creepage, 1, "1", kAfterStepTwoD, "of the wheelset with the largest size; braking forwards positive")

namespace train_dynamics {

// The structs of these lists: of one vehicle (or of a pack of vehicles), of all of them, and where the kernels write.

#define TRAIN_DYNAMICS_VALUE(name, numbers, unit, presence, meaning) \
  Numbers<T, numbers> name = NotComputed<T, numbers>();
#define TRAIN_DYNAMICS_ARRAY(name, numbers, unit, presence, meaning) std::vector<double> name;
#define TRAIN_DYNAMICS_POINTER(name, numbers, unit, presence, meaning) double* name = nullptr;

template <class T>
struct VehicleReply {
  TRAIN_DYNAMICS_VEHICLE_REPLY(TRAIN_DYNAMICS_VALUE)
};
/// [vehicle][number]
struct ReplyArrays {
  TRAIN_DYNAMICS_VEHICLE_REPLY(TRAIN_DYNAMICS_ARRAY)
};
/// Where the numbers of one vehicle begin; those of the vehicles behind it follow.
struct ReplyPlaces {
  TRAIN_DYNAMICS_VEHICLE_REPLY(TRAIN_DYNAMICS_POINTER)
};

template <class T>
struct VehicleRecord {
  TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_DYNAMICS_VALUE)
};
/// [vehicle][number]
struct RecordArrays {
  TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_DYNAMICS_ARRAY)
};
/// Where the numbers of one vehicle begin; those of the vehicles behind it follow.
struct RecordPlaces {
  TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_DYNAMICS_POINTER)
};

#undef TRAIN_DYNAMICS_VALUE
#undef TRAIN_DYNAMICS_ARRAY
#undef TRAIN_DYNAMICS_POINTER

struct RecordInfo : FieldInfo {
  Presence presence;
};

#define TRAIN_DYNAMICS_CALL(name, numbers, unit, presence, meaning) \
  function(RecordInfo{{#name, unit, meaning, numbers}, Presence::presence}, structs.name...);

/// Calls function(RecordInfo, field, field ...) for each field of the list that the structs are of. Messages are such
/// structs, too: one that lacks a field does not compile.
template <class Function, class... Structs>
void ForEachReplyField(Function&& function, Structs&... structs) {
  TRAIN_DYNAMICS_VEHICLE_REPLY(TRAIN_DYNAMICS_CALL)
}
template <class Function, class... Structs>
void ForEachRecordField(Function&& function, Structs&... structs) {
  TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_DYNAMICS_CALL)
}

#undef TRAIN_DYNAMICS_CALL
#define TRAIN_DYNAMICS_PLUS(name, numbers, unit, presence, meaning) +numbers

inline constexpr int kReplyNumbers = 0 TRAIN_DYNAMICS_VEHICLE_REPLY(TRAIN_DYNAMICS_PLUS);    ///< of each vehicle
inline constexpr int kRecordNumbers = 0 TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_DYNAMICS_PLUS);  ///< of each vehicle

#undef TRAIN_DYNAMICS_PLUS

/// Gives the arrays of that name in a struct or message their sizes for so many vehicles.
template <class Arrays>
void ResizeReply(std::size_t vehicles, Arrays& arrays) {
  ForEachReplyField([vehicles](const RecordInfo& field, auto& array) { array.resize(vehicles * field.numbers); },
                    arrays);
}
template <class Arrays>
void ResizeRecord(std::size_t vehicles, Arrays& arrays) {
  ForEachRecordField([vehicles](const RecordInfo& field, auto& array) { array.resize(vehicles * field.numbers); },
                     arrays);
}

/// The places of vehicle `at`.
inline ReplyPlaces PlacesOf(ReplyArrays& arrays, std::size_t at) {
  ReplyPlaces places;
  ForEachReplyField(
      [at](const RecordInfo& field, auto& array, auto& place) { place = array.data() + at * field.numbers; }, arrays,
      places);
  return places;
}
inline RecordPlaces PlacesOf(RecordArrays& arrays, std::size_t at) {
  RecordPlaces places;
  ForEachRecordField(
      [at](const RecordInfo& field, auto& array, auto& place) { place = array.data() + at * field.numbers; }, arrays,
      places);
  return places;
}

}  // namespace train_dynamics
