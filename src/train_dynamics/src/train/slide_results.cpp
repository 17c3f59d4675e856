#include "train_dynamics/train/slide_results.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {
namespace {

constexpr double kLookEvery = 0.5;  ///< [m]
/// Limits [m] that no train exceeds, but a damaged checkpoint may: distance between two samples, length of the track.
constexpr double kLongestWay = 1e5, kLongestTrack = 1e7;

/// Spreads work evenly over the metres of a distance.
void Spread(double from_m, double to_m, double creep_j, double brake_j, TrackWork& track) {
  if (from_m > to_m) std::swap(from_m, to_m);
  if (!(to_m - from_m < kLongestWay) || !(std::abs(from_m) < 1e15)) return;
  const long first = std::lround(std::floor(from_m)), last = std::lround(std::floor(to_m));
  if (track.creep_j.empty()) track.from_m = first;
  if (static_cast<double>(std::abs(first - track.from_m)) > kLongestTrack) return;
  if (first < track.from_m) {
    // Room for the metres to come, not only for this one: trains keep their direction.
    const long before = track.from_m - first + 1000;
    track.creep_j.insert(track.creep_j.begin(), before, 0.0);
    track.brake_j.insert(track.brake_j.begin(), before, 0.0);
    track.from_m -= before;
  }
  const auto needed = static_cast<std::size_t>(last - track.from_m + 1);
  if (track.creep_j.size() < needed) {
    track.creep_j.resize(needed, 0.0);
    track.brake_j.resize(needed, 0.0);
  }
  const double way = to_m - from_m;
  for (long metre = first; metre <= last; ++metre) {
    const double begin = std::max(from_m, static_cast<double>(metre));
    const double end = std::min(to_m, static_cast<double>(metre + 1));
    const double share = first == last ? 1.0 : (end - begin) / way;
    track.creep_j[metre - track.from_m] += share * creep_j;
    track.brake_j[metre - track.from_m] += share * brake_j;
  }
}

}  // namespace

SlideResults::SlideResults(const ScenarioParams& scenario) {
  for (std::size_t group = 0; group < scenario.train.consist.size(); ++group) {
    const ConsistGroupParams& of = scenario.train.consist[group];
    Kind kind;
    if (scenario.ModelOfGroup(group) == VehicleModel::kTwoD) {
      WithBogieVehicle(of.vehicle, [&kind](const auto& vehicle) {
        kind.wheelsets = vehicle.kWheelsets;
        std::copy(vehicle.wheelset_offset_m.begin(), vehicle.wheelset_offset_m.end(), kind.offset_m);
      });
    }
    kind_.insert(kind_.end(), of.count, kinds_.size());
    kinds_.push_back(kind);
  }
  seen_.resize(kind_.size());
}

void SlideResults::Observe(const TrainRecord& record) {
  for (const SlideEvent& event : record.slides) {
    const auto same = std::find_if(ongoing_.begin(), ongoing_.end(), [&event](const SlideEvent& known) {
      return known.vehicle == event.vehicle && known.wheelset == event.wheelset;
    });
    if (same != ongoing_.end()) ongoing_.erase(same);
    (event.is_over == 0.0 ? ongoing_ : slides_).push_back(event);
  }
  if (std::none_of(kinds_.begin(), kinds_.end(), [](const Kind& kind) { return kind.wheelsets > 0; })) return;
  for (std::size_t i = 0; i < kind_.size(); ++i) {
    seen_[i].position_m = record.vehicles.position_m[i];
    std::memcpy(seen_[i].work_j, &(*record.wheelset_work_j)[2 * kMostWheelsets * i], sizeof seen_[i].work_j);
  }
  if (deposited_.empty()) deposited_ = seen_;
  for (std::size_t i = 0; i < kind_.size(); ++i) {
    if (std::abs(seen_[i].position_m - deposited_[i].position_m) < kLookEvery) continue;
    Deposit(kinds_[kind_[i]], deposited_[i], seen_[i], track_);
    deposited_[i] = seen_[i];
  }
}

void SlideResults::Deposit(const Kind& kind, const Seen& from, const Seen& to, TrackWork& track) const {
  for (int j = 0; j < kind.wheelsets; ++j) {
    const double creep_j = to.work_j[j] - from.work_j[j];
    const double brake_j = to.work_j[kMostWheelsets + j] - from.work_j[kMostWheelsets + j];
    if (creep_j == 0.0 && brake_j == 0.0) continue;
    Spread(from.position_m + kind.offset_m[j], to.position_m + kind.offset_m[j], creep_j, brake_j, track);
  }
}

std::vector<SlideEvent> SlideResults::Slides() const {
  std::vector<SlideEvent> slides = slides_;
  slides.insert(slides.end(), ongoing_.begin(), ongoing_.end());
  std::sort(slides.begin(), slides.end(), [](const SlideEvent& a, const SlideEvent& b) {
    return std::tie(a.start_s, a.vehicle, a.wheelset) < std::tie(b.start_s, b.vehicle, b.wheelset);
  });
  return slides;
}

std::vector<WheelsetSlides> SlideResults::Wheelsets() const {
  std::map<std::pair<int, int>, WheelsetSlides> wheelsets;
  for (const SlideEvent& event : Slides()) {
    const auto vehicle = static_cast<int>(event.vehicle), wheelset = static_cast<int>(event.wheelset);
    WheelsetSlides& of = wheelsets[{vehicle, wheelset}];
    of.vehicle = vehicle;
    of.wheelset = wheelset;
    of.slides += 1;
    of.slid_s += event.end_s - event.start_s;
    of.slid_m += event.slid_m;
    of.locked_s += event.locked_s;
    of.locked_m += event.locked_m;
    of.longest_lock_s = std::max(of.longest_lock_s, event.longest_lock_s);
    of.energy_j += event.energy_j;
    of.largest_lock_j = std::max(of.largest_lock_j, event.largest_lock_j);
    of.largest_adhesion = std::max(of.largest_adhesion, event.largest_adhesion);
  }
  std::vector<WheelsetSlides> list;
  list.reserve(wheelsets.size());
  for (const auto& [key, of] : wheelsets) list.push_back(of);
  return list;
}

TrackWork SlideResults::Track() const {
  TrackWork track = track_;
  for (std::size_t i = 0; i < deposited_.size(); ++i) Deposit(kinds_[kind_[i]], deposited_[i], seen_[i], track);
  std::size_t unused = 0;
  while (unused < track.creep_j.size() && track.creep_j[unused] == 0.0 && track.brake_j[unused] == 0.0) ++unused;
  const auto begin = static_cast<std::ptrdiff_t>(unused);
  track.creep_j.erase(track.creep_j.begin(), track.creep_j.begin() + begin);
  track.brake_j.erase(track.brake_j.begin(), track.brake_j.begin() + begin);
  track.from_m += static_cast<long>(begin);
  return track;
}

std::vector<double> SlideResults::Memory() const {
  const std::vector<SlideEvent> slides = Slides();
  std::vector<double> memory = {static_cast<double>(slides.size()), static_cast<double>(track_.from_m),
                                static_cast<double>(track_.creep_j.size()), static_cast<double>(deposited_.size())};
  const auto append = [&memory](const void* numbers, std::size_t count) {
    if (count == 0) return;
    const std::size_t at = memory.size();
    memory.resize(at + count);
    std::memcpy(&memory[at], numbers, count * sizeof(double));
  };
  append(slides.data(), slides.size() * kSlideNumbers);
  append(track_.creep_j.data(), track_.creep_j.size());
  append(track_.brake_j.data(), track_.brake_j.size());
  constexpr std::size_t kSeen = sizeof(Seen) / sizeof(double);
  append(deposited_.data(), deposited_.size() * kSeen);
  append(seen_.data(), deposited_.size() * kSeen);
  return memory;
}

void SlideResults::SetMemory(const std::vector<double>& memory) {
  constexpr std::size_t kHead = 4, kSeen = sizeof(Seen) / sizeof(double);
  if (memory.size() < kHead) throw SnapshotError("has too few numbers");
  const auto count = [](double number) {
    if (!(number >= 0.0 && number < 1e9)) throw SnapshotError("is damaged: no such count");
    return static_cast<std::size_t>(number);
  };
  const std::size_t slides = count(memory[0]), metres = count(memory[2]), vehicles = count(memory[3]);
  if ((vehicles != 0 && vehicles != kind_.size()) || !(std::abs(memory[1]) < 1e15) ||
      memory.size() != kHead + slides * kSlideNumbers + 2 * metres + 2 * vehicles * kSeen) {
    throw SnapshotError("is of other slides");
  }
  const double* at = memory.data() + kHead;
  const auto take = [&at](void* to, std::size_t numbers) {
    if (numbers > 0) std::memcpy(to, at, numbers * sizeof(double));
    at += numbers;
  };
  std::vector<SlideEvent> events(slides);
  take(events.data(), slides * kSlideNumbers);
  for (const SlideEvent& event : events) (event.is_over == 0.0 ? ongoing_ : slides_).push_back(event);
  track_.from_m = static_cast<long>(memory[1]);
  track_.creep_j.resize(metres);
  take(track_.creep_j.data(), metres);
  track_.brake_j.resize(metres);
  take(track_.brake_j.data(), metres);
  deposited_.resize(vehicles);
  take(deposited_.data(), vehicles * kSeen);
  if (vehicles > 0) take(seen_.data(), vehicles * kSeen);
}

}  // namespace train_dynamics
