#include "train_dynamics/vehicle/slide_watch.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace train_dynamics {

template <class Vehicle>
struct SlideWatch<Vehicle>::Motion {
  double at_m;           ///< along the track
  double way_m, turn_m;  ///< of the wheelset and, at the tread, of its rotation since the start
  double speed_mps, tread_mps;
  double creep_j;  ///< since the start

  double Slip() const { return std::abs(speed_mps - tread_mps); }
  bool Slides() const { return Slip() > slide::kCreepage * std::max(std::abs(speed_mps), slide::kSlowest); }
  bool IsLocked() const {
    return std::abs(speed_mps) > slide::kSlowest && std::abs(tread_mps) < slide::kLocked * std::abs(speed_mps);
  }
};

template <class Vehicle>
typename SlideWatch<Vehicle>::Motion SlideWatch<Vehicle>::MotionOf(const VehicleBatch<Vehicle>& batch, int i,
                                                                   int wheelset) {
  const Vehicle& vehicle = batch.vehicle();
  const double radius_m = vehicle.rolling.radius_m;
  Motion motion;
  motion.way_m = batch.NumberOf(i, Vehicle::kFirstWay + wheelset);
  motion.turn_m = radius_m * batch.NumberOf(i, Vehicle::kFirstTurn + wheelset);
  motion.speed_mps = batch.NumberOf(i, Vehicle::kFirstSpeed + wheelset);
  motion.tread_mps = radius_m * batch.NumberOf(i, Vehicle::kFirstSpin + wheelset);
  motion.creep_j = batch.NumberOf(i, Vehicle::kFirstCreep + wheelset);
  motion.at_m = batch.NumberOf(i, 0) + motion.way_m + vehicle.wheelset_offset_m[wheelset];
  return motion;
}

template <class Vehicle>
void SlideWatch<Vehicle>::EndLock(const Motion& now, Followed& f) {
  if (f.lock_s == 0.0) return;
  f.locked_s += f.lock_s;
  f.locked_m += std::abs(now.way_m - f.lock_way_m);
  if (f.lock_s > f.longest_lock_s) {
    f.longest_lock_s = f.lock_s;
    f.longest_lock_from_s = f.lock_from_s;
  }
  f.largest_lock_j = std::max(f.largest_lock_j, now.creep_j - f.lock_creep_j);
  f.lock_s = 0.0;
}

template <class Vehicle>
SlideEvent SlideWatch<Vehicle>::EventOf(const Followed& followed, const Motion& now, double time_s, int wheelset) {
  Followed f = followed;
  EndLock(now, f);
  SlideEvent event;
  event.wheelset = wheelset + 1;
  event.start_s = f.start_s;
  event.end_s = time_s;
  event.is_over = 1.0;
  event.start_m = f.start_m;
  event.end_m = now.at_m;
  event.slid_m = std::abs((now.way_m - f.start_way_m) - (now.turn_m - f.start_turn_m));
  event.locked_s = f.locked_s;
  event.locked_m = f.locked_m;
  event.longest_lock_s = f.longest_lock_s;
  event.longest_lock_from_s = f.longest_lock_from_s;
  event.energy_j = now.creep_j - f.start_creep_j;
  event.largest_lock_j = f.largest_lock_j;
  event.largest_adhesion = f.largest_adhesion;
  event.largest_creepage = f.largest_creepage;
  return event;
}

template <class Vehicle>
void SlideWatch<Vehicle>::Follow(double time_s, double interval_s, const VehicleBatch<Vehicle>& batch) {
  if (!watching_ && !batch.AnySlip(slide::kCreepage, slide::kSlowest)) return;
  watching_ = false;
  for (int i = 0; i < batch.size(); ++i) {
    Update(time_s, interval_s, batch, i);
    watching_ |= sliding_[i] != 0;
  }
}

template <class Vehicle>
void SlideWatch<Vehicle>::Update(double time_s, double interval_s, const VehicleBatch<Vehicle>& batch, int i) {
  sliding_[i] = 0;
  for (int j = 0; j < kWheelsets; ++j) {
    Followed& f = vehicles_[i].wheelset[j];
    const Motion now = MotionOf(batch, i, j);
    if (!now.Slides()) {
      if (f.slides == 0.0) continue;
      if (time_s - f.start_s >= slide::kLeastDuration * (1.0 - 1e-9)) {
        vehicles_[i].ended.push_back(EventOf(f, now, time_s, j));
        has_ended_ = true;
      }
      f = Followed();
      continue;
    }
    sliding_[i] = 1;
    if (f.slides == 0.0) {
      f = Followed();
      f.slides = 1.0;
      f.start_s = time_s;
      f.start_m = now.at_m;
      f.start_way_m = now.way_m;
      f.start_turn_m = now.turn_m;
      f.start_creep_j = now.creep_j;
    } else {
      const double force = batch.OutputNumberOf(i, Vehicle::kFirstCreepForce + j);
      const double normal = batch.OutputNumberOf(i, j);
      if (normal > 0.0) f.largest_adhesion = std::max(f.largest_adhesion, std::abs(force) / normal);
    }
    f.largest_creepage = std::max(f.largest_creepage, now.Slip() / std::max(std::abs(now.speed_mps), slide::kSlowest));
    if (!now.IsLocked()) {
      EndLock(now, f);
    } else if (f.lock_s > 0.0) {
      f.lock_s += interval_s;
    } else {
      f.lock_s = interval_s;
      f.lock_from_s = time_s;
      f.lock_way_m = now.way_m;
      f.lock_creep_j = now.creep_j;
    }
  }
}

template <class Vehicle>
void SlideWatch<Vehicle>::Tell(int first, bool ongoing, double time_s, const VehicleBatch<Vehicle>& batch,
                               std::vector<SlideEvent>& slides) {
  if (!has_ended_ && !(ongoing && watching_)) return;
  has_ended_ = false;
  for (int i = 0; i < batch.size(); ++i) {
    std::vector<SlideEvent>& ended = vehicles_[i].ended;
    for (const SlideEvent& event : ended) {
      slides.push_back(event);
      slides.back().vehicle = first + i;
    }
    ended.clear();
    if (!ongoing || sliding_[i] == 0) continue;
    for (int j = 0; j < kWheelsets; ++j) {
      const Followed& f = vehicles_[i].wheelset[j];
      if (f.slides == 0.0 || time_s - f.start_s < slide::kLeastDuration) continue;
      slides.push_back(EventOf(f, MotionOf(batch, i, j), time_s, j));
      slides.back().vehicle = first + i;
      slides.back().is_over = 0.0;
    }
  }
}

template <class Vehicle>
void SlideWatch<Vehicle>::Save(int i, std::vector<double>& row) const {
  const PerVehicle& vehicle = vehicles_[i];
  if (sliding_[i] == 0 && vehicle.ended.empty()) return;
  const auto append = [&row](const void* numbers, std::size_t count) {
    const std::size_t at = row.size();
    row.resize(at + count);
    std::memcpy(&row[at], numbers, count * sizeof(double));
  };
  append(vehicle.wheelset.data(), kWheelsets * kFollowed);
  for (const SlideEvent& event : vehicle.ended) append(&event, kSlideNumbers);
}

template <class Vehicle>
bool SlideWatch<Vehicle>::Restore(int i, const double* numbers, std::size_t count) {
  PerVehicle& vehicle = vehicles_[i];
  vehicle = PerVehicle();
  sliding_[i] = 0;
  if (count > 0) {
    constexpr std::size_t kOwn = kWheelsets * kFollowed;
    if (count < kOwn || (count - kOwn) % kSlideNumbers != 0) return false;
    std::memcpy(static_cast<void*>(vehicle.wheelset.data()), numbers, kOwn * sizeof(double));
    vehicle.ended.resize((count - kOwn) / kSlideNumbers);
    for (std::size_t k = 0; k < vehicle.ended.size(); ++k) {
      std::memcpy(static_cast<void*>(&vehicle.ended[k]), numbers + kOwn + k * kSlideNumbers, sizeof(SlideEvent));
    }
    for (const Followed& f : vehicle.wheelset) sliding_[i] |= static_cast<char>(f.slides != 0.0);
  }
  watching_ = std::any_of(sliding_.begin(), sliding_.end(), [](char slides) { return slides != 0; });
  has_ended_ = std::any_of(vehicles_.begin(), vehicles_.end(), [](const PerVehicle& of) { return !of.ended.empty(); });
  return true;
}

template class SlideWatch<Wagon>;
template class SlideWatch<SixAxleVehicle>;

}  // namespace train_dynamics
