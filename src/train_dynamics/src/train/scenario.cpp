#include "train_dynamics/train/scenario.h"

#include <algorithm>
#include <cmath>

namespace train_dynamics {
namespace {

/// How many parts make up a whole that is known to be a multiple.
long Parts(double whole, double part) { return std::lround(whole / part); }

}  // namespace

const char* ModelName(VehicleModel model) {
  switch (model) {
    case VehicleModel::kLtd:
      return "ltd";
    case VehicleModel::kLtdNoInertia:
      return "ltd-no-inertia";
    default:
      return "2d";
  }
}

int VehicleIndex(int number, int vehicles) {
  const int index = number > 0 ? number - 1 : vehicles + number;
  return number != 0 && index >= 0 && index < vehicles ? index : -1;
}

int ScenarioParams::StepsPerExchange() const { return static_cast<int>(Parts(exchange_interval_s, dt_s)); }
long ScenarioParams::Exchanges() const { return Parts(duration_s, exchange_interval_s); }
int ScenarioParams::ExchangesPerRecord() const {
  return static_cast<int>(Parts(record_interval_s, exchange_interval_s));
}
int ScenarioParams::RecordsPerLedger() const {
  return static_cast<int>(Parts(ledger_interval_s, record_interval_s));
}

std::vector<int> ScenarioParams::DetailedVehicles() const {
  std::vector<int> detailed;
  if (model != VehicleModel::kTwoD) return detailed;
  const int vehicles = train.VehicleCount();
  for (int number : detail_vehicles) detailed.push_back(VehicleIndex(number, vehicles));
  std::sort(detailed.begin(), detailed.end());
  detailed.erase(std::unique(detailed.begin(), detailed.end()), detailed.end());
  return detailed;
}

bool ScenarioParams::Multiple(double whole, double part) {
  const double ratio = whole / part;
  return ratio > 0.5 && ratio < 1e9 &&
         std::abs(ratio - std::round(ratio)) < 1e-6 * std::max(1.0, 1e-3 * ratio);
}

bool ScenarioParams::CommandTimesAscend() const {
  return std::is_sorted(commands.begin(), commands.end(),
                        [](const BrakeCommand& a, const BrakeCommand& b) { return a.time_s < b.time_s; });
}

bool ScenarioParams::ReductionsMeasured() const {
  if (!brake) return true;
  const std::vector<double>& measured = brake->service.reduction_kpa;
  return std::all_of(commands.begin(), commands.end(), [&measured](const BrakeCommand& c) {
    return c.kind != BrakeCommandKind::kApply ||
           (!measured.empty() && c.reduction_kpa >= measured.front() && c.reduction_kpa <= measured.back());
  });
}

bool ScenarioParams::SourcesInTrain() const {
  if (!brake) return true;
  const int n = train.VehicleCount();
  return std::all_of(brake->sources.begin(), brake->sources.end(),
                     [n](const BrakeSourceParams& s) { return VehicleIndex(s.vehicle, n) >= 0; });
}

bool ScenarioParams::DetailInTrain() const {
  const int n = train.VehicleCount();
  return std::all_of(detail_vehicles.begin(), detail_vehicles.end(),
                     [n](int v) { return VehicleIndex(v, n) >= 0; });
}

}  // namespace train_dynamics
