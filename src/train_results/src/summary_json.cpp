#include "train_results/summary_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "train_dynamics/train/ranks.h"

namespace train_results {
namespace {

using Json = nlohmann::ordered_json;
using train_dynamics::ForceExtremes;
using train_dynamics::RunSummary;
using train_dynamics::TrainMaster;

constexpr double kKmhPerMps = 3.6;

/// A number, or null in place of one that is not finite.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// The largest force over all connections; null for a train without connections.
Json Extreme(const std::vector<ForceExtremes>& extremes, double ForceExtremes::*force, double ForceExtremes::*time) {
  const auto largest = std::max_element(extremes.begin(), extremes.end(), [force](const auto& a, const auto& b) {
    return std::abs(a.*force) < std::abs(b.*force);
  });
  if (largest == extremes.end()) return {};
  return {{"value", Number((*largest).*force)},
          {"connection", largest - extremes.begin() + 1},
          {"time_s", Number((*largest).*time)}};
}

Json Partings(const TrainMaster& master) {
  Json list = Json::array();
  for (const train_dynamics::Parting& parting : master.in_train_forces().Partings())
    list.push_back({{"connection", parting.connection + 1}, {"time_s", Number(parting.time_s)}});
  return list;
}

/// For a train with external vehicles: which node moves which vehicles.
Json External(const train_dynamics::ScenarioParams& scenario) {
  Json nodes = Json::array();
  for (const train_dynamics::Rank& rank : train_dynamics::ExternalRanks(scenario.train))
    nodes.push_back({{"node", rank.name}, {"first_vehicle", rank.first + 1}, {"vehicles", rank.count}});
  return nodes;
}

/// The commands that were given by conditions, or live.
Json Commands(const RunSummary& summary, const TrainMaster& master) {
  Json list = Json::array();
  for (const train_dynamics::GivenCommand& given : master.schedule().Given()) {
    list.push_back({{"time_s", static_cast<double>(given.exchange) * summary.scenario().exchange_interval_s},
                    {"exchange", given.exchange},
                    {"command", given.command.Text()},
                    {"live", given.is_live}});
  }
  return list;
}

Json Stops(const RunSummary& summary) {
  Json list = Json::array();
  for (const RunSummary::Stop& stop : summary.stops()) {
    list.push_back(
        {{"time_s", Number(stop.time_s)}, {"distance_m", Number(stop.distance_m)}, {"until_s", Number(stop.until_s)}});
  }
  return list;
}

Json Twin(const RunSummary& summary, const TrainMaster& master) {
  const auto& twin = summary.twin();
  if (!twin) return {};
  const std::vector<ForceExtremes> own = master.in_train_forces().Extremes();
  double tension_n = 0.0, compression_n = 0.0;
  for (std::size_t c = 0; c < std::min(own.size(), twin->extremes.size()); ++c) {
    tension_n = std::max(tension_n, std::abs(own[c].tension_n - twin->extremes[c].tension_n));
    compression_n = std::max(compression_n, std::abs(own[c].compression_n - twin->extremes[c].compression_n));
  }
  return {{"start_offset_kmh", twin->start_offset_kmh},
          {"max_tension_spread_n", tension_n},
          {"max_compression_spread_n", compression_n},
          {"distance_spread_m", Number(std::abs(summary.mean_distance_m() - twin->distance_m))},
          {"final_speed_spread_kmh", Number(kKmhPerMps * std::abs(summary.mean_speed_mps() - twin->mean_speed_mps))}};
}

Json Slides(const RunSummary& summary) {
  int events = 0, flat_risks = 0;
  double energy_j = 0.0;
  Json wheelsets = Json::array();
  for (const train_dynamics::WheelsetSlides& of : summary.slides().Wheelsets()) {
    events += of.slides;
    flat_risks += of.FlatRisk() ? 1 : 0;
    energy_j += of.energy_j;
    wheelsets.push_back({{"vehicle", of.vehicle},
                         {"wheelset", of.wheelset},
                         {"slides", of.slides},
                         {"slid_s", Number(of.slid_s)},
                         {"slid_m", Number(of.slid_m)},
                         {"locked_s", Number(of.locked_s)},
                         {"locked_m", Number(of.locked_m)},
                         {"longest_lock_s", Number(of.longest_lock_s)},
                         {"energy_j", Number(of.energy_j)},
                         {"largest_lock_j", Number(of.largest_lock_j)},
                         {"largest_adhesion", Number(of.largest_adhesion)},
                         {"flat_risk", of.FlatRisk()}});
  }
  return {{"slides", events},
          {"energy_j", Number(energy_j)},
          {"flat_risks", flat_risks},
          {"wheelsets", std::move(wheelsets)}};
}

Json Energy(const RunSummary& summary, const TrainMaster& master) {
  const train_dynamics::EnergyLedger& ledger = summary.ledger();
  const double initial_j = master.at_time_zero().stored_energy_j;
  Json energy{{"time_s", Number(ledger.time_s)},
              {"initial_j", Number(initial_j)},
              {"final_j", Number(ledger.Stored())},
              {"gravity_work_j", Number(ledger.gravity_work_j)},
              {"traction_work_j", Number(ledger.traction_work_j)}};
  if (master.locomotives().TellsEnergy()) {
    energy["taken_j"] = Number(master.locomotives().EnergyTaken());
    energy["fuel_kg"] = Number(master.locomotives().FuelMass());
  }
  Json& dissipated = energy["dissipated_j"] = Json::object();
  for (const auto& [element, of_element] : ledger.dissipated_j) dissipated[element] = Number(of_element);
  energy["residual_j"] = Number(ledger.Residual(initial_j));
  energy["residual_share"] = Number(summary.ResidualShare(master));
  return energy;
}

}  // namespace

std::string SummaryJson(const RunSummary& summary, const TrainMaster& master, double wall_s, const std::string& fault) {
  const train_dynamics::ScenarioParams& scenario = summary.scenario();
  const double own_s = master.time_s() - master.start_s();  // of this process: without what it was resumed from
  const double vehicle_steps = own_s / scenario.dt_s * summary.vehicles();
  const std::vector<ForceExtremes> extremes = master.in_train_forces().Extremes();
  Json json;
  json["version"] = TRAIN_BRAKE_VERSION;
  json["scenario"] = scenario.name;
  json["model"] = scenario.ModelNames();
  json["vehicles"] = summary.vehicles();
  if (Json external = External(scenario); !external.empty()) {
    json["external"] = std::move(external);
    // The values of external vehicles that this program knows.
    json["external_covered"] = {
        {"state_digest", "motion of the coupler heads at records, and the digest that a node gives"},
        {"energy", "work of the couplers on them"}};
  }
  json["dt_s"] = scenario.dt_s;
  json["exchange_interval_s"] = scenario.exchange_interval_s;
  json["simulated_s"] = Number(master.time_s());
  json["resumed_at_s"] = master.start_s() > 0.0 ? Number(master.start_s()) : Json();
  json["wall_s"] = Number(wall_s);
  json["real_time_factor"] = Number(own_s / wall_s);
  json["ns_per_vehicle_step"] = Number(1e9 * wall_s / vehicle_steps);
  json["complete"] = master.Done();
  json["ended_by"] = master.Done() ? Json(master.EndedByUntil() ? "until" : "duration_s") : Json();
  json["commands"] = Commands(summary, master);
  json["fault"] = fault.empty() ? Json() : Json(fault);
  json["distance_m"] = Number(summary.mean_distance_m());
  json["final_speed_kmh"] = {{"mean", Number(kKmhPerMps * summary.mean_speed_mps())},
                             {"lead", Number(kKmhPerMps * summary.lead_speed_mps())},
                             {"tail", Number(kKmhPerMps * summary.tail_speed_mps())}};
  json["stopped"] = summary.Stands();
  json["stop_time_s"] = summary.Stands() ? Number(summary.stops().back().time_s) : Json();
  json["stop_distance_m"] = summary.Stands() ? Number(summary.stops().back().distance_m) : Json();
  json["stops"] = Stops(summary);
  json["rolled_back"] = summary.RolledBack();
  json["left_route_s"] = Number(summary.left_route_s());
  json["rolled_back_m"] = Number(summary.BehindFurthest());
  json["max_tension_n"] = Extreme(extremes, &ForceExtremes::tension_n, &ForceExtremes::tension_time_s);
  json["max_compression_n"] = Extreme(extremes, &ForceExtremes::compression_n, &ForceExtremes::compression_time_s);
  json["partings"] = Partings(master);
  json["twin"] = Twin(summary, master);
  json["slides"] = Slides(summary);
  json["energy"] = Energy(summary, master);
  json["state_digest"] = fmt::format("{:016x}", summary.state_digest());
  constexpr int kIndent = 2;
  // Texts of scenarios may hold any bytes.
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace train_results
