#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "train_dynamics/train/train_master.h"
#include "train_dynamics/vehicle/slide_event.h"

namespace train_dynamics {

/// Totals of the slides of one wheelset over a run.
struct WheelsetSlides {
  int vehicle = 0, wheelset = 0;  ///< from 1
  int slides = 0;
  double slid_s = 0.0, slid_m = 0.0;
  double locked_s = 0.0, locked_m = 0.0, longest_lock_s = 0.0;
  double energy_j = 0.0, largest_lock_j = 0.0;
  double largest_adhesion = 0.0;
  bool FlatRisk() const { return largest_lock_j > slide::kFlatRisk; }
};

/// Work of wheels on the rails, by metre of track, over all wheelsets of the 2D model that ran over it.
struct TrackWork {
  long from_m = 0;              ///< the first entry is of [from_m, from_m + 1)
  std::vector<double> creep_j;  ///< lost in creep: the sum of T-gamma |F s| [N] per metre
  std::vector<double> brake_j;  ///< of the longitudinal force on the rail, braking positive: the sum of forces [N]
};

/// Collects slides and the work on the track from a run's records as they pass.
///
/// Between two samples of a vehicle, half a metre or one record apart, its work is spread evenly over the distance. The
/// sum over the track is the ledger's creep account, up to rounding.
class SlideResults {
 public:
  explicit SlideResults(const ScenarioParams& scenario);

  /// An observer of the run's TrainMaster.
  void Observe(const TrainRecord& record);

  /// All slides, ongoing ones included, in the order of their start, then of vehicles and wheelsets.
  std::vector<SlideEvent> Slides() const;
  /// Of the wheelsets that have slid, in the order of vehicles and wheelsets.
  std::vector<WheelsetSlides> Wheelsets() const;
  TrackWork Track() const;

  std::vector<double> Memory() const;
  /// @throws SnapshotError if the numbers are not such a state
  void SetMemory(const std::vector<double>& memory);

 private:
  /// Where a vehicle stood, and the work of its wheelsets, when it was last deposited on the track or last seen.
  struct Seen {
    double position_m = 0.0;
    double work_j[2 * kMostWheelsets] = {};
  };
  struct Kind {
    int wheelsets = 0;  ///< 0: not of the 2D model
    double offset_m[kMostWheelsets] = {};
  };

  void Deposit(const Kind& kind, const Seen& from, const Seen& to, TrackWork& track) const;

  std::vector<Kind> kinds_;
  std::vector<std::size_t> kind_;  ///< [vehicle]
  std::vector<SlideEvent> slides_, ongoing_;
  TrackWork track_;
  std::vector<Seen> deposited_, seen_;  ///< [vehicle]
};

}  // namespace train_dynamics
