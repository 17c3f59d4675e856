#pragma once

#include <array>
#include <vector>

#include "train_dynamics/vehicle/slide_event.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics {

/// Monitors the wheelsets of a batch and reports their slides. Evaluated at the end of every exchange, vehicle by
/// vehicle, but only if a wheel of the batch slides; the result depends on each vehicle alone.
template <class Vehicle>
class SlideWatch {
 public:
  static constexpr int kWheelsets = Vehicle::kWheelsets;

  explicit SlideWatch(int vehicles) : vehicles_(vehicles), sliding_(vehicles, 0) {}

  /// Whether it wants the output of the next step: some wheelset slides.
  bool watching() const { return watching_; }

  /// The state at the end of an exchange. @param interval_s  its length
  void Follow(double time_s, double interval_s, const VehicleBatch<Vehicle>& batch);

  /// Appends the slides that have ended since the last call, of each vehicle in turn.
  /// @param first    number of the batch's first vehicle in the train, from 1
  /// @param ongoing  also the ongoing ones, as they are now
  void Tell(int first, bool ongoing, double time_s, const VehicleBatch<Vehicle>& batch,
            std::vector<SlideEvent>& slides);

  /// Appends the state of a vehicle: no numbers if no wheelset slides.
  void Save(int i, std::vector<double>& row) const;
  /// @return whether the numbers are such a state
  bool Restore(int i, const double* numbers, std::size_t count);

  static constexpr int kSharedNumbers() { return kWheelsets * (kFollowed + kSharedSlidesPerWheelset * kSlideNumbers); }

 private:
  /// A wheelset. A row of numbers.
  struct Followed {
    double slides = 0.0;  ///< 1: its creepage is above the limit
    double start_s = 0.0, start_m = 0.0, start_way_m = 0.0, start_turn_m = 0.0, start_creep_j = 0.0;
    double lock_s = 0.0, lock_from_s = 0.0, lock_way_m = 0.0,
           lock_creep_j = 0.0;  ///< of the present lock: its length, where it began
    double locked_s = 0.0, locked_m = 0.0, longest_lock_s = 0.0, longest_lock_from_s = 0.0, largest_lock_j = 0.0;
    double largest_adhesion = 0.0, largest_creepage = 0.0;
  };
  static constexpr int kFollowed = sizeof(Followed) / sizeof(double);
  struct PerVehicle {
    std::array<Followed, kWheelsets> wheelset;
    std::vector<SlideEvent> ended;  ///< not reported yet
  };
  struct Motion;

  static Motion MotionOf(const VehicleBatch<Vehicle>& batch, int i, int wheelset);
  static SlideEvent EventOf(const Followed& followed, const Motion& now, double time_s, int wheelset);
  static void EndLock(const Motion& now, Followed& followed);
  void Update(double time_s, double interval_s, const VehicleBatch<Vehicle>& batch, int i);

  std::vector<PerVehicle> vehicles_;
  std::vector<char> sliding_;  ///< [vehicle] whether a wheelset of it slides
  bool watching_ = false;
  bool has_ended_ = false;
};

}  // namespace train_dynamics
