#pragma once

#include <vector>

/// A slide of one wheelset:
///   X(name, unit, meaning)
/// In messages: the arrays of this name in Slides.msg, and side by side in RankRecord.slides. In tables: the columns of
/// slides.csv.
#define TRAIN_DYNAMICS_SLIDE_EVENT(X)                                                                   \
  X(vehicle, "1", "number of the vehicle in the train, from 1")                                         \
  X(wheelset, "1", "number of the wheelset in the vehicle, from 1 at its front")                        \
  X(start_s, "s", "when the creepage rose above 0.3")                                                   \
  X(end_s, "s", "when it fell below; of an ongoing slide: the time of this message")                    \
  X(is_over, "1", "1; 0 of an ongoing slide")                                                           \
  X(start_m, "m", "position of the wheelset along the track at its start")                              \
  X(end_m, "m", "... at its end")                                                                       \
  X(slid_m, "m", "distance the tread slid over the rail, >= 0")                                         \
  X(locked_s, "s", "time with locked wheels, above 3 km/h")                                             \
  X(locked_m, "m", "distance run with locked wheels")                                                   \
  X(longest_lock_s, "s", "the longest lock in one piece")                                               \
  X(longest_lock_from_s, "s", "when that began; 0 without a lock")                                      \
  X(energy_j, "J", "lost in creep over the slide, both wheels")                                         \
  X(largest_lock_j, "J", "lost in creep during the lock that took most")                                \
  X(largest_adhesion, "1", "largest share of creep force in normal force, from the second exchange on") \
  X(largest_creepage, "1", "largest slip speed over the wheelset's speed, from 3 km/h on; >= 0")

namespace train_dynamics {

/// When a wheelset slides, and when it is locked. Both count above kSlowest only: near standstill the ratio of two
/// small speeds says nothing.
namespace slide {
inline constexpr double kCreepage = 0.3;       ///< beyond it a wheelset slides ...
inline constexpr double kLeastDuration = 0.2;  ///< ... if it does for so long [s]
inline constexpr double kLocked = 0.02;        ///< |omega r| / |v| below which it is locked
inline constexpr double kSlowest = 3.0 / 3.6;  ///< [m/s]
inline constexpr double kFlatRisk = 30e3;      ///< [J] in one lock: risk of a flat [A]
}  // namespace slide

#define TRAIN_DYNAMICS_VALUE(name, unit, meaning) double name = 0.0;
struct SlideEvent {
  TRAIN_DYNAMICS_SLIDE_EVENT(TRAIN_DYNAMICS_VALUE)
};
#undef TRAIN_DYNAMICS_VALUE

#define TRAIN_DYNAMICS_PLUS(name, unit, meaning) +1
inline constexpr int kSlideNumbers = 0 TRAIN_DYNAMICS_SLIDE_EVENT(TRAIN_DYNAMICS_PLUS);
#undef TRAIN_DYNAMICS_PLUS
static_assert(sizeof(SlideEvent) == kSlideNumbers * sizeof(double), "a row of numbers");

/// Calls function(name, unit, field ...) for each field of slides or messages of them.
#define TRAIN_DYNAMICS_CALL(name, unit, meaning) function(#name, unit, structs.name...);
template <class Function, class... Structs>
void ForEachSlideField(Function&& function, Structs&... structs) {
  TRAIN_DYNAMICS_SLIDE_EVENT(TRAIN_DYNAMICS_CALL)
}
#undef TRAIN_DYNAMICS_CALL

/// Slides of one wheelset for which memory that is shared with the master has room. Records with more slides (of
/// intervals above half a second) are sent by TCP.
inline constexpr int kSharedSlidesPerWheelset = 4;

}  // namespace train_dynamics
