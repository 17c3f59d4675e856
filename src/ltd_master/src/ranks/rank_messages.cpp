#include "ltd_master/ranks/rank_messages.h"

#include <fmt/format.h>
#include <train_brake_msgs/wagon_detail.h>

#include <algorithm>
#include <cmath>

#include "ltd_master/ranks/late_watch.h"
#include "strict_config/writer.h"
#include "train_dynamics/train/snapshot.h"

namespace ltd_master {
namespace {

using train_dynamics::ExchangeReply;
using train_dynamics::ExchangeRequest;
using train_dynamics::Rank;

/// What of a record has been computed. The rest is NaN.
enum class Computed {
  kMotion,     ///< nothing has acted on the vehicles yet
  kShoeForce,  ///< of forces and creepages this alone: LTD
  kAll,
};

template <class Values>
bool AllFinite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Copies arrays of a rank's reply to their places in those of the whole train.
class Unpacker {
 public:
  Unpacker(const Rank& rank, const std::string& when) : rank_(rank), when_(when) {}

  template <class From, class To>
  void Copy(const char* name, const From& from, To& to) const {
    CheckSize(name, from.size(), static_cast<std::size_t>(rank_.count));
    std::copy(from.begin(), from.end(), to.begin() + rank_.first);
  }

  void CopyFinite(const char* name, const std::vector<double>& from, std::vector<double>& to) const {
    Copy(name, from, to);
    CheckFinite(name, from);
  }

  void CheckFinite(const char* name, const std::vector<double>& from) const {
    const auto wrong =
        std::find_if(from.begin(), from.end(), [](double value) { return !std::isfinite(value); });
    if (wrong != from.end()) {
      Fail(fmt::format("replied {} = {} for vehicle {}", name, *wrong,
                       rank_.first + 1 + (wrong - from.begin())));
    }
  }

  void Record(const train_brake_msgs::RankRecord& record, Computed computed, ExchangeReply& reply) const {
    CopyFinite("position_m", record.position_m, reply.position_m);
    CopyFinite("speed_mps", record.speed_mps, reply.speed_mps);
    Copy("shoe_force_n", record.shoe_force_n, reply.shoe_force_n);
    Copy("wheel_force_n", record.wheel_force_n, reply.wheel_force_n);
    Copy("creepage", record.creepage, reply.creepage);
    Copy("state_digest", record.state_digest, reply.state_digest);
    if (computed != Computed::kMotion) CheckFinite("shoe_force_n", record.shoe_force_n);
    if (computed == Computed::kAll) {
      CheckFinite("wheel_force_n", record.wheel_force_n);
      CheckFinite("creepage", record.creepage);
    }
    auto from = record.details.begin();
    for (train_dynamics::WagonDetail& detail : reply.details) {
      if (detail.vehicle < rank_.first || detail.vehicle >= rank_.first + rank_.count) continue;
      if (from == record.details.end() || static_cast<int>(from->vehicle) != detail.vehicle + 1) {
        Fail(fmt::format("replied no details of vehicle {}", detail.vehicle + 1));
      }
      const train_brake_msgs::WagonState& message = *from++;
      train_brake_msgs::MessageToDetail(message, detail);
      if (computed != Computed::kAll) continue;
      train_brake_msgs::ForEachField(detail, message, [&](const auto& values, const auto&) {
        if (AllFinite(values)) return;
        Fail(fmt::format("replied details of vehicle {} that are not finite", detail.vehicle + 1));
      });
    }
  }

  void Energies(const train_brake_msgs::RankRecord& record, ExchangeReply& reply) const {
    const auto count = static_cast<std::size_t>(rank_.count);
    CheckSize("kinetic_j", record.kinetic_j.size(), count);
    CheckSize("potential_j", record.potential_j.size(), count);
    CheckSize("gravity_work_j", record.gravity_work_j.size(), count);
    CheckSize("traction_work_j", record.traction_work_j.size(), count);
    CheckSize("dissipated_j", record.dissipated_j.size(), count * train_dynamics::kDissipations);
    for (const auto* energies : {&record.kinetic_j, &record.potential_j, &record.gravity_work_j,
                                 &record.traction_work_j, &record.dissipated_j}) {
      if (!AllFinite(*energies)) Fail("replied energies that are not finite");
    }
    auto dissipated = record.dissipated_j.begin();
    for (std::size_t i = 0; i < count; ++i) {
      train_dynamics::VehicleEnergy& energy = reply.energy[rank_.first + i];
      energy.kinetic = record.kinetic_j[i];
      energy.potential = record.potential_j[i];
      energy.work.gravity = record.gravity_work_j[i];
      energy.work.traction = record.traction_work_j[i];
      for (double& element : energy.work.dissipated) element = *dissipated++;
    }
  }

  /// @param last  the train's last rank
  void Snapshot(std::uint64_t exchange, const std::vector<std::uint8_t>& bytes, const Rank& last,
                ExchangeReply& reply) const {
    const auto first = static_cast<std::uint64_t>(rank_.first),
               count = static_cast<std::uint64_t>(rank_.count);
    train_dynamics::BlockSnapshot part;
    try {
      part = train_dynamics::DecodeBlockSnapshot(bytes);
    } catch (const train_dynamics::SnapshotError& e) {
      Fail(fmt::format("replied a snapshot that {}", e.what()));
    }
    const std::size_t numbers = part.state.size() / count;
    if (part.exchange != exchange || part.first != first || part.count != count || numbers == 0 ||
        numbers * count != part.state.size()) {
      Fail("replied a snapshot of something else");
    }
    if (!AllFinite(part.state)) Fail("replied a snapshot that is not finite");
    reply.snapshot.resize((last.first + last.count) * numbers);
    std::copy(part.state.begin(), part.state.end(),
              reply.snapshot.begin() + static_cast<long>(first * numbers));
  }

  /// @param vehicle  place in the train, from 1
  void CheckHosted(std::uint32_t vehicle) const {
    const auto first = static_cast<std::uint32_t>(rank_.first),
               count = static_cast<std::uint32_t>(rank_.count);
    if (vehicle > first && vehicle <= first + count) return;
    Fail(fmt::format("replied a fault of vehicle {}, which it does not have", vehicle));
  }

  [[noreturn]] void Fail(const std::string& what) const { throw RankFailure(rank_, when_, what); }

 private:
  void CheckSize(const char* name, std::size_t size, std::size_t expected) const {
    if (size != expected) {
      Fail(fmt::format("replied {} values of {}, {} are expected", size, name, expected));
    }
  }

  const Rank& rank_;
  const std::string& when_;
};

}  // namespace

std::string ExchangeText(std::uint64_t exchange) { return fmt::format("exchange {}", exchange); }

RankMessages::RankMessages(const std::vector<Rank>& ranks, std::uint64_t run_id,
                           const train_dynamics::ScenarioParams& scenario)
    : configure(ranks.size()),
      step(ranks.size()),
      ranks_(ranks),
      is_two_d_(scenario.model == train_dynamics::VehicleModel::kTwoD) {
  const std::string scenario_text = strict_config::Write(scenario);
  const std::uint64_t digest = train_dynamics::TextDigest(scenario_text);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    train_brake_msgs::ConfigureRequest& request = configure[i].request;
    request.protocol_version = train_brake_msgs::ConfigureRequest::PROTOCOL_VERSION;
    request.run_id = run_id;
    request.first_vehicle = static_cast<std::uint32_t>(ranks[i].first + 1);
    request.vehicle_count = static_cast<std::uint32_t>(ranks[i].count);
    request.scenario = scenario_text;
    request.scenario_digest = digest;
    step[i].request.run_id = run_id;
  }
}

void RankMessages::BeginAt(std::uint64_t exchange, const std::vector<double>& snapshot) {
  const Rank& last = ranks_.back();
  const std::size_t vehicles = last.first + last.count, numbers = snapshot.size() / vehicles;
  if (numbers * vehicles != snapshot.size()) {
    throw train_dynamics::SnapshotError(
        fmt::format("has {} numbers, which is not a multiple of {} vehicles", snapshot.size(), vehicles));
  }
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    train_brake_msgs::ConfigureRequest& request = configure[i].request;
    request.exchange = exchange;
    request.snapshot.clear();
    if (snapshot.empty()) continue;
    train_dynamics::BlockSnapshot part;
    part.exchange = exchange;
    part.first = static_cast<std::uint64_t>(ranks_[i].first);
    part.count = static_cast<std::uint64_t>(ranks_[i].count);
    const auto begin = snapshot.begin() + static_cast<long>(part.first * numbers);
    part.state.assign(begin, begin + static_cast<long>(part.count * numbers));
    request.snapshot = Encode(part);
  }
}

void RankMessages::Unpack(ExchangeReply& reply) const {
  const std::string when = kConfiguration;
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    const train_brake_msgs::ConfigureResponse& response = configure[i].response;
    const Unpacker unpacker(ranks_[i], when);
    if (!response.ok) unpacker.Fail(response.message);
    unpacker.CopyFinite("head_displacement_m", response.head_displacement_m, reply.head_displacement_m);
    unpacker.CopyFinite("head_velocity_mps", response.head_velocity_mps, reply.head_velocity_mps);
    unpacker.Record(response.record, Computed::kMotion, reply);
    unpacker.Energies(response.record, reply);
  }
}

void RankMessages::Pack(const ExchangeRequest& whole) {
  for (std::size_t i = 0; i < ranks_.size(); ++i) Pack(whole, static_cast<int>(i), step[i].request);
}

void RankMessages::Pack(const ExchangeRequest& whole, int rank, train_brake_msgs::StepRequest& part) const {
  const auto force = whole.coupler_force_n.begin() + ranks_[rank].first;
  const auto pressure = whole.cylinder_pressure_pa.begin() + ranks_[rank].first;
  part.exchange = whole.exchange;
  part.dt_s = whole.dt_s;
  part.steps = static_cast<std::uint32_t>(whole.steps);
  part.record = whole.record;
  part.ledger = whole.ledger;
  part.snapshot = whole.snapshot;
  part.coupler_force_n.assign(force, force + ranks_[rank].count + 1);
  part.cylinder_pressure_pa.assign(pressure, pressure + ranks_[rank].count);
}

void RankMessages::Unpack(const ExchangeRequest& whole, ExchangeReply& reply) const {
  const std::string when = ExchangeText(whole.exchange);
  const Computed computed = is_two_d_ ? Computed::kAll : Computed::kShoeForce;
  reply.fault = {};
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    const train_brake_msgs::StepResponse& response = step[i].response;
    const Unpacker unpacker(ranks_[i], when);
    if (!response.ok) unpacker.Fail(response.message);
    if (response.exchange != whole.exchange) {
      unpacker.Fail(fmt::format("replied to exchange {}", response.exchange));
    }
    if (response.fault_vehicle != 0) {
      unpacker.CheckHosted(response.fault_vehicle);
      reply.fault = {static_cast<int>(response.fault_vehicle) - 1, response.fault};
      return;
    }
    unpacker.CopyFinite("head_displacement_m", response.head_displacement_m, reply.head_displacement_m);
    unpacker.CopyFinite("head_velocity_mps", response.head_velocity_mps, reply.head_velocity_mps);
    if (whole.record) unpacker.Record(response.record, computed, reply);
    if (whole.ledger) unpacker.Energies(response.record, reply);
    if (whole.snapshot) unpacker.Snapshot(whole.exchange + 1, response.snapshot, ranks_.back(), reply);
  }
}

}  // namespace ltd_master
