#include "train_dynamics/train/run_summary.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "train_dynamics/train/ranks.h"

namespace train_dynamics {
namespace {

/// A train has stopped when its mean speed has come down to this [m/s]; carbodies may rock on for seconds.
constexpr double kStandstill = 1e-3;
/// It is under way again when its mean speed exceeds this [m/s]: more than any rocking.
constexpr double kMoving = 0.1;
/// It has rolled back when it has come back from its furthest place by more than this [m]: more than a slack train does
/// that stretches at rest.
constexpr double kRolledBack = 0.5;
constexpr double kKmhPerMps = 3.6;

std::string Number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", c);
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

/// Of a train with external vehicles: who moves which, and what this program can tell of them.
std::string External(const ScenarioParams& scenario) {
  std::string nodes;
  for (const Rank& rank : ExternalRanks(scenario.train)) {
    nodes += std::string(nodes.empty() ? "" : ", ") + "{\"node\": " + Quoted(rank.name) +
             ", \"first_vehicle\": " + std::to_string(rank.first + 1) +
             ", \"vehicles\": " + std::to_string(rank.count) + "}";
  }
  if (nodes.empty()) return "";
  return ",\n  \"external\": [" + nodes +
         "],\n  \"external_covered\": {\"state_digest\": \"motion of the coupler heads at records, and the "
         "digest that a node "
         "gives\", \"energy\": \"work of the couplers on them\"}";
}

/// The largest force over all connections as a JSON object; null for a train without connections.
std::string Extreme(const std::vector<ForceExtremes>& extremes, double ForceExtremes::*force,
                    double ForceExtremes::*time) {
  const auto largest = std::max_element(
      extremes.begin(), extremes.end(),
      [force](const auto& a, const auto& b) { return std::abs(a.*force) < std::abs(b.*force); });
  if (largest == extremes.end()) return "null";
  return "{\"value\": " + Number((*largest).*force) +
         ", \"connection\": " + std::to_string(largest - extremes.begin() + 1) +
         ", \"time_s\": " + Number((*largest).*time) + "}";
}

/// The connections that broke, as the entries of a JSON array.
std::string Partings(const std::vector<Parting>& partings) {
  std::string entries;
  for (const Parting& parting : partings) {
    entries += (entries.empty() ? "" : ", ") +
               ("{\"connection\": " + std::to_string(parting.connection + 1)) +
               ", \"time_s\": " + Number(parting.time_s) + "}";
  }
  return entries;
}

/// What the locomotives took from tank and line, as entries of a JSON object; none for a train that does not tell it.
std::string EnergyTaken(const Locomotives& locomotives) {
  if (!locomotives.TellsEnergy()) return "";
  return ",\n    \"taken_j\": " + Number(locomotives.EnergyTaken()) +
         ",\n    \"fuel_kg\": " + Number(locomotives.FuelMass());
}

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
  // It may stop and be under way again within one record interval.
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
  return "at " + Number(left_route_s_) +
         " s the train lies beyond an end of its route, which is known from " + Number(route_.from_m) +
         " m to " + Number(route_.to_m) + " m; there, the first and the last of its values hold on";
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

std::string RunSummary::Commands(const TrainMaster& master) const {
  std::string list;
  for (const GivenCommand& given : master.schedule().Given()) {
    list += std::string(list.empty() ? "" : ", ") +
            "{\"time_s\": " + Number(static_cast<double>(given.exchange) * scenario_.exchange_interval_s) +
            ", \"exchange\": " + std::to_string(given.exchange) +
            ", \"command\": " + Quoted(given.command.Text()) +
            ", \"live\": " + (given.is_live ? "true" : "false") + "}";
  }
  return list;
}

double RunSummary::Forward() const { return scenario_.MeanInitialSpeed() < 0.0 ? -1.0 : 1.0; }

double RunSummary::BehindFurthest() const { return furthest_m_ - Forward() * mean_distance_m_; }

bool RunSummary::RolledBack() const { return BehindFurthest() > kRolledBack; }

std::string RunSummary::Stops() const {
  std::string list;
  for (const Stop& stop : stops_) {
    list += std::string(list.empty() ? "" : ", ") + "{\"time_s\": " + Number(stop.time_s) +
            ", \"distance_m\": " + Number(stop.distance_m) + ", \"until_s\": " + Number(stop.until_s) + "}";
  }
  return list;
}

std::string RunSummary::Twin(const TrainMaster& master) const {
  if (!twin_) return "null";
  const std::vector<ForceExtremes> own = master.in_train_forces().Extremes();
  double tension_n = 0.0, compression_n = 0.0;
  for (std::size_t c = 0; c < std::min(own.size(), twin_->extremes.size()); ++c) {
    tension_n = std::max(tension_n, std::abs(own[c].tension_n - twin_->extremes[c].tension_n));
    compression_n =
        std::max(compression_n, std::abs(own[c].compression_n - twin_->extremes[c].compression_n));
  }
  return "{\"start_offset_kmh\": " + Number(twin_->start_offset_kmh) +
         ", \"max_tension_spread_n\": " + Number(tension_n) +
         ", \"max_compression_spread_n\": " + Number(compression_n) +
         ", \"distance_spread_m\": " + Number(std::abs(mean_distance_m_ - twin_->distance_m)) +
         ", \"final_speed_spread_kmh\": " +
         Number(kKmhPerMps * std::abs(mean_speed_mps_ - twin_->mean_speed_mps)) + "}";
}

double RunSummary::ResidualShare(const TrainMaster& master) const {
  const double initial_j = master.at_time_zero().stored_energy_j;
  const double turned_over_j =
      std::max({std::abs(ledger_.Dissipated()), std::abs(ledger_.Stored() - initial_j),
                std::abs(ledger_.gravity_work_j) + std::abs(ledger_.traction_work_j)});
  return turned_over_j > 0.0 ? ledger_.Residual(initial_j) / turned_over_j : 0.0;
}

std::string RunSummary::Slides() const {
  int events = 0, flat_risks = 0;
  double energy_j = 0.0;
  std::string wheelsets;
  for (const WheelsetSlides& of : slides_.Wheelsets()) {
    events += of.slides;
    flat_risks += of.FlatRisk() ? 1 : 0;
    energy_j += of.energy_j;
    wheelsets +=
        std::string(wheelsets.empty() ? "" : ",") + "\n      {\"vehicle\": " + std::to_string(of.vehicle) +
        ", \"wheelset\": " + std::to_string(of.wheelset) + ", \"slides\": " + std::to_string(of.slides) +
        ", \"slid_s\": " + Number(of.slid_s) + ", \"slid_m\": " + Number(of.slid_m) +
        ", \"locked_s\": " + Number(of.locked_s) + ", \"locked_m\": " + Number(of.locked_m) +
        ", \"longest_lock_s\": " + Number(of.longest_lock_s) + ", \"energy_j\": " + Number(of.energy_j) +
        ", \"largest_lock_j\": " + Number(of.largest_lock_j) +
        ", \"largest_adhesion\": " + Number(of.largest_adhesion) +
        ", \"flat_risk\": " + (of.FlatRisk() ? "true" : "false") + "}";
  }
  return "{\n    \"slides\": " + std::to_string(events) + ",\n    \"energy_j\": " + Number(energy_j) +
         ",\n    \"flat_risks\": " + std::to_string(flat_risks) + ",\n    \"wheelsets\": [" + wheelsets +
         "]\n  }";
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

std::string RunSummary::Json(const TrainMaster& master, double wall_s, const std::string& fault) const {
  const double simulated_s = master.time_s();
  const double initial_j = master.at_time_zero().stored_energy_j;
  const double own_s = simulated_s - master.start_s();  // of this process: without what it was resumed from
  const double vehicle_steps = own_s / scenario_.dt_s * vehicles_;
  char digest[20];
  std::snprintf(digest, sizeof digest, "%016" PRIx64, state_digest_);
  std::ostringstream json;
  json << "{\n  \"version\": \"" << TRAIN_BRAKE_VERSION << "\",\n  \"scenario\": " << Quoted(scenario_.name)
       << ",\n  \"model\": \"" << scenario_.ModelNames() << "\",\n  \"vehicles\": " << vehicles_
       << External(scenario_) << ",\n  \"dt_s\": " << Number(scenario_.dt_s)
       << ",\n  \"exchange_interval_s\": " << Number(scenario_.exchange_interval_s)
       << ",\n  \"simulated_s\": " << Number(simulated_s)
       << ",\n  \"resumed_at_s\": " << (master.start_s() > 0.0 ? Number(master.start_s()) : "null")
       << ",\n  \"wall_s\": " << Number(wall_s) << ",\n  \"real_time_factor\": " << Number(own_s / wall_s)
       << ",\n  \"ns_per_vehicle_step\": " << Number(1e9 * wall_s / vehicle_steps)
       << ",\n  \"complete\": " << (master.Done() ? "true" : "false") << ",\n  \"ended_by\": "
       << (!master.Done()          ? "null"
           : master.EndedByUntil() ? "\"until\""
                                   : "\"duration_s\"")
       << ",\n  \"commands\": [" << Commands(master) << "]"
       << ",\n  \"fault\": " << (fault.empty() ? "null" : Quoted(fault))
       << ",\n  \"final_speed_kmh\": {\"mean\": " << Number(kKmhPerMps * mean_speed_mps_)
       << ", \"lead\": " << Number(kKmhPerMps * lead_speed_mps_)
       << ", \"tail\": " << Number(kKmhPerMps * tail_speed_mps_)
       << "},\n  \"stopped\": " << (Stands() ? "true" : "false")
       << ",\n  \"stop_time_s\": " << Number(Stands() ? stops_.back().time_s : kNone)
       << ",\n  \"stop_distance_m\": " << Number(Stands() ? stops_.back().distance_m : kNone)
       << ",\n  \"stops\": [" << Stops() << "],\n  \"rolled_back\": " << (RolledBack() ? "true" : "false")
       << ",\n  \"left_route_s\": " << Number(left_route_s_)
       << ",\n  \"rolled_back_m\": " << Number(BehindFurthest()) << ",\n  \"max_tension_n\": "
       << Extreme(master.in_train_forces().Extremes(), &ForceExtremes::tension_n,
                  &ForceExtremes::tension_time_s)
       << ",\n  \"max_compression_n\": "
       << Extreme(master.in_train_forces().Extremes(), &ForceExtremes::compression_n,
                  &ForceExtremes::compression_time_s)
       << ",\n  \"partings\": [" << Partings(master.in_train_forces().Partings())
       << "],\n  \"twin\": " << Twin(master) << ",\n  \"slides\": " << Slides()
       << ",\n  \"energy\": {\n    \"time_s\": " << Number(ledger_.time_s)
       << ",\n    \"initial_j\": " << Number(initial_j) << ",\n    \"final_j\": " << Number(ledger_.Stored())
       << ",\n    \"gravity_work_j\": " << Number(ledger_.gravity_work_j)
       << ",\n    \"traction_work_j\": " << Number(ledger_.traction_work_j)
       << EnergyTaken(master.locomotives()) << ",\n    \"dissipated_j\": {";
  const char* separator = "";
  for (const auto& [element, energy] : ledger_.dissipated_j) {
    json << separator << "\n      " << Quoted(element) << ": " << Number(energy);
    separator = ",";
  }
  json << "\n    },\n    \"residual_j\": " << Number(ledger_.Residual(initial_j))
       << ",\n    \"residual_share\": " << Number(ResidualShare(master)) << "\n  },\n  \"state_digest\": \""
       << digest << "\"\n}\n";
  return json.str();
}

}  // namespace train_dynamics
