#include "wagon_node/wagon_server.h"

#include <train_brake_msgs/wagon_detail.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "strict_config/reader.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/train/threaded_block.h"

namespace wagon_node {
namespace {

using train_brake_msgs::ConfigureRequest;
using train_brake_msgs::ConfigureResponse;
using train_brake_msgs::RankRecord;
using train_brake_msgs::StepRequest;
using train_brake_msgs::StepResponse;
using train_dynamics::ScenarioParams;

/// Why a request is refused.
class Refusal : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string Text(std::uint64_t value) { return std::to_string(value); }

std::string Hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016" PRIx64, value);
  return text;
}

ScenarioParams Read(const std::string& scenario) {
  strict_config::ErrorList errors;
  ScenarioParams params = strict_config::LoadText<ScenarioParams>(scenario, "scenario", errors);
  if (!errors.empty()) throw Refusal("the scenario cannot be used:\n" + errors.Text(5));
  return params;
}

/// Those of the train's detailed vehicles that are in the rank.
std::vector<int> DetailedVehicles(const ScenarioParams& scenario, const train_dynamics::Rank& rank) {
  std::vector<int> detailed;
  for (const int vehicle : scenario.DetailedVehicles()) {
    if (vehicle >= rank.first && vehicle < rank.first + rank.count) detailed.push_back(vehicle);
  }
  return detailed;
}

/// What is replied to every exchange, from the arrays of the vehicles to those of a message.
template <class Response>
void CopyReply(const train_dynamics::ExchangeReply& state, Response& response) {
  train_dynamics::ForEachReplyField([](const train_dynamics::RecordInfo&, const auto& from, auto& to) { to = from; },
                                    state, response);
}

/// What is wrong with an array of a request; empty: nothing.
std::string Check(const char* name, const std::vector<double>& values, std::size_t expected,
                  train_dynamics::Given given) {
  const bool may_be_empty = given == train_dynamics::Given::kWhereUsed;
  if (values.size() != expected && !(may_be_empty && values.empty())) {
    return std::string(name) + " has " + Text(values.size()) + " values, expected " + Text(expected) +
           (may_be_empty ? " or none" : "");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    return std::string(name) + "[" + Text(i) + "] is " + std::to_string(values[i]) + ", must be finite";
  }
  return {};
}

using Patches = std::vector<train_dynamics::FrictionPatchParams>;

/// Whether the patches of a request begin with those of earlier requests.
bool BeginWith(const Patches& known, const std::vector<double>& numbers) {
  if (numbers.size() < 3 * known.size()) return false;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double* patch = &numbers[3 * i];
    if (patch[0] != known[i].from_m || patch[1] != known[i].to_m || patch[2] != *known[i].friction_coefficient)
      return false;
  }
  return true;
}

/// What is wrong with the patches of a request; empty: nothing.
std::string CheckPatches(const Patches& known, const std::vector<double>& numbers) {
  constexpr std::size_t kMost = 3 * train_dynamics::kMostPatchesOnTheWay;
  if (numbers.size() % 3 != 0 || numbers.size() > kMost)
    return "friction_patches has " + Text(numbers.size()) + " values, expected three for each patch, at most " +
           Text(kMost);
  if (!BeginWith(known, numbers)) return "friction_patches does not begin with those of the exchange before";
  for (std::size_t at = 0; at < numbers.size(); at += 3) {
    const double from_m = numbers[at], to_m = numbers[at + 1], friction = numbers[at + 2];
    if (std::isfinite(from_m) && std::isfinite(to_m) && from_m < to_m && friction > 0.0 && friction <= 1.0) continue;
    return "friction_patches from [" + Text(at) + "] on is no patch of rail";
  }
  return {};
}

}  // namespace

/// One rank's part of a run.
struct WagonServer::Run {
  Run(std::uint64_t run_id, const ScenarioParams& params, const train_dynamics::Consist& consist, int first, int count,
      int threads)
      : id(run_id),
        scenario(params),
        rank{train_dynamics::VehicleName(first, consist.vehicles()), first, count},
        vehicles_in_train(consist.vehicles()),
        steps(static_cast<std::uint32_t>(params.StepsPerExchange())),
        vehicles(params, consist, first, count, train_dynamics::UsefulThreads(params, first, count, threads)),
        state(count, DetailedVehicles(params, rank)) {}

  bool IsRepeated(const StepRequest& request) const { return has_replied && request.exchange == next_exchange - 1; }
  /// Whether a request would move the vehicles as the last one has.
  bool HasLastInputs(const StepRequest& request) const {
    return request.dt_s == loads.dt_s && request.steps == steps &&
           request.friction_patches.size() == 3 * loads.friction_patches.size() &&
           BeginWith(loads.friction_patches, request.friction_patches) && train_dynamics::AreSameLoads(request, loads);
  }
  /// Brings the vehicles to a snapshot. @throws SnapshotError
  void Restore(std::uint64_t exchange, const std::vector<std::uint8_t>& bytes);
  std::vector<std::uint8_t> Snapshot() const;
  /// The state as a record, with the loads that led to it.
  void Fill(bool with_energy, RankRecord& record) const;

  const std::uint64_t id;
  const ScenarioParams scenario;
  const train_dynamics::Rank rank;
  const int vehicles_in_train;
  const std::uint32_t steps;  ///< per exchange
  train_dynamics::ThreadedBlock vehicles;
  train_dynamics::ExchangeRequest loads;
  train_dynamics::ExchangeReply state;
  std::uint64_t next_exchange = 0;
  bool has_replied = false;  ///< to a Step
  StepResponse last_reply;
};

void WagonServer::Run::Restore(std::uint64_t exchange, const std::vector<std::uint8_t>& bytes) {
  using train_dynamics::SnapshotError;
  const train_dynamics::BlockSnapshot snapshot = train_dynamics::DecodeBlockSnapshot(bytes);
  const std::size_t count = snapshot.states.size();
  if (snapshot.first != static_cast<std::uint64_t>(rank.first) || count != static_cast<std::size_t>(rank.count)) {
    throw SnapshotError("is of " + Text(count) + " vehicle(s) from " + Text(snapshot.first + 1) + " on, not of " +
                        train_dynamics::VehiclesText(rank));
  }
  if (snapshot.exchange != exchange) {
    throw SnapshotError("is of exchange " + Text(snapshot.exchange) + ", not of exchange " + Text(exchange));
  }
  vehicles.Restore(snapshot.states.data());
  next_exchange = exchange;
}

std::vector<std::uint8_t> WagonServer::Run::Snapshot() const {
  train_dynamics::BlockSnapshot snapshot;
  snapshot.exchange = next_exchange;
  snapshot.first = static_cast<std::uint64_t>(rank.first);
  snapshot.states.resize(rank.count);
  vehicles.Save(snapshot.states.data());
  return train_dynamics::Encode(snapshot);
}

void WagonServer::Run::Fill(bool with_energy, RankRecord& record) const {
  train_dynamics::ForEachRecordField([](const train_dynamics::RecordInfo&, const auto& from, auto& to) { to = from; },
                                     state, record);
  record.state_digest = state.state_digest;
  record.wheelset_work_j = state.wheelset_work_j;
  const auto* slides = reinterpret_cast<const double*>(state.slides.data());
  record.slides.assign(slides, slides + state.slides.size() * train_dynamics::kSlideNumbers);
  record.details.resize(state.details.size());
  for (std::size_t i = 0; i < state.details.size(); ++i) {
    const train_dynamics::WagonDetail& detail = state.details[i];
    train_brake_msgs::WagonState& message = record.details[i];
    train_brake_msgs::DetailToMessage(detail, message);
    message.header.stamp.fromSec(static_cast<double>(next_exchange) * scenario.exchange_interval_s);
    message.exchange = next_exchange;
    message.vehicle = static_cast<std::uint32_t>(detail.vehicle + 1);
    if (!has_replied) continue;  // nothing has acted on the vehicle yet
    const int at = detail.vehicle - rank.first;
    using Load = decltype(message.cylinder_pressure_pa);
    message.front_coupler_force_n = static_cast<Load>(loads.coupler_force_n[at]);
    message.rear_coupler_force_n = static_cast<Load>(loads.coupler_force_n[at + 1]);
    message.cylinder_pressure_pa = static_cast<Load>(loads.cylinder_pressure_pa[at]);
  }
  if (!with_energy) return;
  train_dynamics::ResizeEnergies(state.energy.size(), record);
  for (std::size_t i = 0; i < state.energy.size(); ++i) {
    train_dynamics::PutEnergy(state.energy[i], i, record);
  }
}

WagonServer::WagonServer(int threads) : threads_(threads) {}
WagonServer::~WagonServer() = default;

std::uint64_t WagonServer::run_id() const { return run_ ? run_->id : 0; }
int WagonServer::vehicles_in_train() const { return run_ ? run_->vehicles_in_train : 0; }

void WagonServer::Configure(const ConfigureRequest& request, bool driven, ConfigureResponse& response) {
  response = ConfigureResponse();
  response.protocol_version = ConfigureRequest::PROTOCOL_VERSION;
  response.scenario_digest = train_dynamics::TextDigest(request.scenario);
  try {
    std::unique_ptr<Run> run = Begin(request, driven, response.scenario_digest);
    run->vehicles.Report(0, true, run->state);
    CopyReply(run->state, response);
    run->Fill(true, response.record);
    response.threads = static_cast<std::uint32_t>(run->vehicles.threads());
    response.gives_snapshots = true;
    response.ok = true;
    response.message = train_dynamics::VehiclesText(run->rank) + " of " + Text(run->vehicles_in_train) + ", scenario " +
                       run->scenario.name + ", run " + Text(run->id);
    run_ = std::move(run);
  } catch (const train_dynamics::SnapshotError& e) {
    response.message = std::string("the snapshot ") + e.what();
  } catch (const std::exception& e) {  // a refusal, or parameters that a vehicle does not take
    response.message = e.what();
  }
}

std::unique_ptr<WagonServer::Run> WagonServer::Begin(const ConfigureRequest& request, bool driven,
                                                     std::uint64_t digest) const {
  if (request.protocol_version != ConfigureRequest::PROTOCOL_VERSION) {
    throw Refusal("the master speaks protocol version " + Text(request.protocol_version) +
                  ", this wagon node version " + Text(ConfigureRequest::PROTOCOL_VERSION) +
                  ": both must be of the same build");
  }
  if (request.scenario_digest != digest) {
    throw Refusal("the scenario should have the digest " + Hex(request.scenario_digest) + ", but has " + Hex(digest) +
                  " as it arrived");
  }
  if (request.run_id == 0) throw Refusal("run_id is 0, which stands for no run");
  if (run_ && request.run_id == run_->id && run_->next_exchange > 0 && !request.again) {
    throw Refusal("run " + Text(run_->id) + " is configured already, and exchange " + Text(run_->next_exchange) +
                  " is next");
  }
  if (run_ && request.run_id != run_->id && driven) {
    throw Refusal("this wagon node is driven in another run, and run " + Text(request.run_id) +
                  " must wait until that has ended");
  }
  const ScenarioParams scenario = Read(request.scenario);
  const train_dynamics::Consist consist(scenario.train);
  const std::uint64_t first = request.first_vehicle, count = request.vehicle_count;
  const auto vehicles = static_cast<std::uint64_t>(consist.vehicles());
  if (first < 1 || count < 1 || first - 1 + count > vehicles) {
    throw Refusal("first_vehicle " + Text(first) + " and vehicle_count " + Text(count) + " are not in a train of " +
                  Text(vehicles) + " vehicles");
  }
  auto run = std::make_unique<Run>(request.run_id, scenario, consist, static_cast<int>(first - 1),
                                   static_cast<int>(count), threads_);
  if (!request.snapshot.empty()) {
    run->Restore(request.exchange, request.snapshot);
  } else if (request.exchange != 0) {
    throw Refusal("exchange " + Text(request.exchange) + " cannot be begun without a snapshot");
  }
  return run;
}

const StepResponse& WagonServer::Step(const StepRequest& request) {
  const std::string why_not = WhyNot(request);
  if (!why_not.empty()) {
    refusal_.ok = false;
    refusal_.message = why_not;
    refusal_.exchange = request.exchange;
    return refusal_;
  }
  Run& run = *run_;
  StepResponse& reply = run.last_reply;
  if (run.IsRepeated(request)) return reply;

  run.loads.exchange = request.exchange;
  run.loads.dt_s = request.dt_s;
  run.loads.steps = static_cast<int>(request.steps);
  run.loads.record = request.record;
  run.loads.ledger = request.ledger;
  for (std::size_t at = 3 * run.loads.friction_patches.size(); at < request.friction_patches.size(); at += 3) {
    const double* patch = &request.friction_patches[at];
    run.loads.friction_patches.push_back({patch[0], patch[1], patch[2], {}, {}});
  }
  train_dynamics::CopyLoads(request, 0, run.rank.count, run.loads);
  const bool sound = run.vehicles.Advance(run.loads, 0, run.state);
  ++run.next_exchange;
  if (request.record) {
    run.state.slides.clear();
    run.vehicles.TellSlides(request.ledger, run.scenario.exchange_interval_s * static_cast<double>(run.next_exchange),
                            run.state.slides);
  }
  run.has_replied = true;

  reply.ok = true;
  reply.exchange = request.exchange;
  CopyReply(run.state, reply);
  const train_dynamics::VehicleFault fault = sound ? train_dynamics::VehicleFault() : run.vehicles.FindFault();
  reply.fault_vehicle = static_cast<std::uint32_t>(fault.vehicle + 1);
  reply.fault = fault.what;
  if (!reply.record.state_digest.empty()) reply.record = RankRecord();  // of an earlier exchange
  if (request.record) run.Fill(request.ledger, reply.record);
  reply.snapshot.clear();
  if (request.snapshot) reply.snapshot = run.Snapshot();
  return reply;
}

std::string WagonServer::WhyNot(const StepRequest& request) const {
  if (!run_) return "this wagon node has no run yet: Configure comes first";
  const Run& run = *run_;
  if (request.run_id != run.id) {
    return "run " + Text(request.run_id) + " is not known here: this wagon node is in another run";
  }
  if (run.IsRepeated(request)) {
    if (run.HasLastInputs(request)) return {};
    return "exchange " + Text(request.exchange) + " has been computed already, with other loads";
  }
  if (request.exchange != run.next_exchange) {
    return "exchange " + Text(request.exchange) +
           (request.exchange < run.next_exchange ? " is past" : " leaves a gap") + ": exchange " +
           Text(run.next_exchange) + " is next";
  }
  if (request.dt_s != run.scenario.dt_s || request.steps != run.steps) {
    using train_dynamics::ShortestDecimal;
    return Text(request.steps) + " steps of " + ShortestDecimal(request.dt_s) + " s are asked for, but it is " +
           Text(run.steps) + " of " + ShortestDecimal(run.scenario.dt_s) + " s in the scenario";
  }
  const auto count = static_cast<std::size_t>(run.rank.count);
  std::string wrong = Check("coupler_force_n", request.coupler_force_n, count + 1, train_dynamics::Given::kAlways);
  train_dynamics::ForEachLoad(
      [&](const train_dynamics::LoadInfo& load, const auto& values) {
        if (wrong.empty()) wrong = Check(load.name, values, count, load.given);
      },
      request);
  if (wrong.empty()) wrong = CheckPatches(run.loads.friction_patches, request.friction_patches);
  return wrong;
}

}  // namespace wagon_node
