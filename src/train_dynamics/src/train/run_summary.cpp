#include "train_dynamics/train/run_summary.h"

#include <algorithm>
#include <cmath>

namespace train_dynamics {
namespace {

/// A train has stopped when its mean speed has come down to this [m/s]; carbodies may rock on for seconds.
constexpr double kStandstill = 1e-3;
/// It moves again when its mean speed exceeds this [m/s]: more than any rocking.
constexpr double kMoving = 0.1;
/// It has rolled back when it has come back from its furthest position by more than this [m]: more than a bunched train
/// that stretches at rest.
constexpr double kRolledBack = 0.5;

}  // namespace

void RunSummary::Observe(const TrainRecord& record) {
  const std::vector<double>& speed = record.vehicles.speed_mps;
  vehicles_ = static_cast<int>(speed.size());
  mean_speed_mps_ = record.mean_speed_mps;
  lead_speed_mps_ = speed.front();
  tail_speed_mps_ = speed.back();
  mean_distance_m_ = record.mean_position_m - record.at_time_zero.mean_position_m;
  JudgeMotion(record);
  slides_.Observe(record);
  if (record.ledger) ledger_ = *record.ledger;
  state_digest_ = record.state_digest;
}

void RunSummary::JudgeMotion(const TrainRecord& record) {
  const bool turns = last_speed_mps_ * mean_speed_mps_ < 0.0;  // false where there is no record before
  last_speed_mps_ = mean_speed_mps_;
  if (!Stands() && (std::abs(mean_speed_mps_) <= kStandstill || turns)) {
    stops_.push_back({record.time_s, mean_distance_m_, kNone});
  }
  // It may stop and move again within one record interval.
  if (Stands() && std::abs(mean_speed_mps_) > kMoving) stops_.back().until_s = record.time_s;
  furthest_m_ = std::max(furthest_m_, Forward() * mean_distance_m_);
  const std::vector<double>& position_m = record.vehicles.position_m;
  const std::vector<ConsistGroupParams>& groups = scenario_.train.consist;
  const bool is_beyond = position_m.front() + 0.5 * groups.front().vehicle.length_m > route_.to_m ||
                         position_m.back() - 0.5 * groups.back().vehicle.length_m < route_.from_m;
  if (is_beyond && std::isnan(left_route_s_)) left_route_s_ = record.time_s;
}

std::string RunSummary::RouteWarning() const {
  if (std::isnan(left_route_s_)) return "";
  return "at " + ShortestDecimal(left_route_s_) + " s the train lies beyond an end of its route, which is known from " +
         ShortestDecimal(route_.from_m) + " m to " + ShortestDecimal(route_.to_m) +
         " m; there, the first and the last of its values hold on";
}

template <class Self, class Function>
void RunSummary::ForEachMemory(Self& self, Function& function) {
  function(self.furthest_m_);
  function(self.last_speed_mps_);
  function(self.left_route_s_);
  for (auto& stop : self.stops_) {
    function(stop.time_s);
    function(stop.distance_m);
    function(stop.until_s);
  }
}

double RunSummary::Forward() const { return scenario_.MeanInitialSpeed() < 0.0 ? -1.0 : 1.0; }

double RunSummary::BehindFurthest() const { return furthest_m_ - Forward() * mean_distance_m_; }

bool RunSummary::RolledBack() const { return BehindFurthest() > kRolledBack; }

double RunSummary::ResidualShare(const TrainMaster& master) const {
  const double initial_j = master.at_time_zero().stored_energy_j;
  const double turned_over_j = std::max({std::abs(ledger_.Dissipated()), std::abs(ledger_.Stored() - initial_j),
                                         std::abs(ledger_.gravity_work_j) + std::abs(ledger_.traction_work_j)});
  return turned_over_j > 0.0 ? ledger_.Residual(initial_j) / turned_over_j : 0.0;
}

std::vector<double> RunSummary::Memory() const {
  const std::vector<double> slides = slides_.Memory();
  MemoryWriter writer;
  writer(static_cast<double>(slides.size()));
  for (const double number : slides) writer(number);
  ForEachMemory(*this, writer);
  return writer.Take();
}

void RunSummary::SetMemory(const std::vector<double>& whole) {
  if (whole.empty() || !(whole[0] >= 0.0 && whole[0] < static_cast<double>(whole.size()))) {
    throw SnapshotError("has too few numbers");
  }
  const auto after_slides = whole.begin() + 1 + static_cast<std::ptrdiff_t>(whole[0]);
  slides_.SetMemory({whole.begin() + 1, after_slides});
  const std::vector<double> memory(after_slides, whole.end());
  constexpr std::size_t kHead = 3, kStop = 3;  // numbers
  stops_.assign(memory.size() > kHead ? (memory.size() - kHead) / kStop : 0, {kNone, kNone, kNone});
  MemoryReader reader(memory);
  ForEachMemory(*this, reader);
  reader.End();
}

}  // namespace train_dynamics
