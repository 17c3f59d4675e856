#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/train/slide_results.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {

/// Results of a run with a slightly different start: shows to how many newtons the maxima of a run are determined.
struct TwinRun {
  double start_offset_kmh = 0.0;        ///< of every vehicle's speed
  std::vector<ForceExtremes> extremes;  ///< [connection]
  double distance_m = 0.0, mean_speed_mps = 0.0;
};

/// Results of a run. Collected from its records as they pass.
class RunSummary {
 public:
  explicit RunSummary(const ScenarioParams& scenario)
      : scenario_(scenario), slides_(scenario), route_(scenario.track.Extent()) {}

  /// An observer of the run's TrainMaster.
  void Observe(const TrainRecord& record);

  /// Sets the twin whose divergence from the run the summary reports.
  void SetTwin(TwinRun twin) { twin_ = std::move(twin); }

  /// The ledger's residual [-], relative to the largest of: energy dissipated, change of stored energy, work of gravity
  /// and traction. 0 if all of them are 0.
  double ResidualShare(const TrainMaster& master) const;
  double mean_speed_mps() const { return mean_speed_mps_; }
  double mean_distance_m() const { return mean_distance_m_; }
  double lead_speed_mps() const { return lead_speed_mps_; }
  double tail_speed_mps() const { return tail_speed_mps_; }
  int vehicles() const { return vehicles_; }
  double left_route_s() const { return left_route_s_; }   ///< NaN: it did not
  const EnergyLedger& ledger() const { return ledger_; }  ///< the last one
  std::uint64_t state_digest() const { return state_digest_; }
  const ScenarioParams& scenario() const { return scenario_; }
  const std::optional<TwinRun>& twin() const { return twin_; }

  /// A stop of the train.
  struct Stop {
    double time_s, distance_m;
    double until_s;  ///< when it moved again; NaN: it is still at rest
  };

  const std::vector<Stop>& stops() const { return stops_; }
  bool Stands() const { return !stops_.empty() && !(stops_.back().until_s == stops_.back().until_s); }
  double BehindFurthest() const;  ///< [m] distance that the train has come back from its furthest position
  bool RolledBack() const;

  /// The slides of the run so far, and the work on its track.
  const SlideResults& slides() const { return slides_; }

  /// A sentence about a train that came to lie beyond an end of its route; empty if it did not.
  std::string RouteWarning() const;

  /// The state that the summary of a resumed run needs from its earlier part.
  std::vector<double> Memory() const;
  /// @throws SnapshotError if the numbers are not such a state
  void SetMemory(const std::vector<double>& memory);

 private:
  /// Calls function(number) for each number of the memory.
  template <class Self, class Function>
  static void ForEachMemory(Self& self, Function& function);

  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  void JudgeMotion(const TrainRecord& record);
  double Forward() const;  ///< 1 or -1: the direction of the start

  const ScenarioParams& scenario_;
  SlideResults slides_;
  std::optional<TwinRun> twin_;
  Stretch route_;
  double left_route_s_ = kNone;  ///< when an end of the train was first beyond an end of the route
  double mean_speed_mps_ = 0.0, lead_speed_mps_ = 0.0, tail_speed_mps_ = 0.0;
  double mean_distance_m_ = 0.0;
  int vehicles_ = 0;
  std::vector<Stop> stops_;
  double furthest_m_ = 0.0;        ///< largest distance so far, in the direction of the start
  double last_speed_mps_ = kNone;  ///< mean, at the record before; NaN: there is none
  EnergyLedger ledger_;            ///< the last one
  std::uint64_t state_digest_ = 0;
};

}  // namespace train_dynamics
