#include "ltd_master/ranks/rank_messages.h"

#include <fmt/format.h>
#include <train_brake_msgs/wagon_detail.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ltd_master/ranks/late_watch.h"
#include "strict_config/writer.h"
#include "train_dynamics/train/snapshot.h"

namespace ltd_master {
namespace {

using train_dynamics::ExchangeReply;
using train_dynamics::ExchangeRequest;
using train_dynamics::Rank;
using train_dynamics::RecordInfo;
using train_dynamics::StateRow;
using train_dynamics::VehicleModel;

template <class Values>
bool AllFinite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// The snapshot of external vehicles, of a format of their own, as the row of the first of them.
StateRow RowOf(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }
/// @throws SnapshotError if the row is not one of bytes
std::vector<std::uint8_t> BytesOf(const StateRow& row) {
  std::vector<std::uint8_t> bytes;
  for (const double number : row) {
    const auto byte = static_cast<std::uint8_t>(std::clamp(number, 0.0, 255.0));
    if (static_cast<double>(byte) != number) throw train_dynamics::SnapshotError("is not one of external vehicles");
    bytes.push_back(byte);
  }
  if (bytes.empty()) throw train_dynamics::SnapshotError("has nothing of external vehicles");
  return bytes;
}

/// Copies arrays of a rank's reply to their places in those of the whole train.
class Unpacker {
 public:
  Unpacker(const Rank& rank, const std::string& when) : rank_(rank), when_(when) {}

  /// What every exchange replies.
  template <class Response>
  void Reply(const Response& response, ExchangeReply& reply) const {
    const auto always = [](std::size_t) { return true; };
    train_dynamics::ForEachReplyField(
        [&](const RecordInfo& field, const auto& from, auto& to) { Copy(field, from, always, to); }, response, reply);
  }

  /// @param models  [vehicle of the train]
  /// @param moved   whether something has acted on the vehicles
  void Record(const train_brake_msgs::RankRecord& record, const std::vector<VehicleModel>& models, bool moved,
              ExchangeReply& reply) const {
    train_dynamics::ForEachRecordField(
        [&](const RecordInfo& field, const auto& from, auto& to) {
          const auto is_computed = [&](std::size_t i) {
            return train_dynamics::IsComputed(field.presence, models[rank_.first + i], moved);
          };
          Copy(field, from, is_computed, to);
        },
        record, reply);
    CheckSize("state_digest", record.state_digest.size(), Count());
    std::copy(record.state_digest.begin(), record.state_digest.end(), reply.state_digest.begin() + rank_.first);
    constexpr std::size_t kWork = 2 * train_dynamics::kMostWheelsets;
    CheckSize("wheelset_work_j", record.wheelset_work_j.size(), kWork * Count());
    if (!AllFinite(record.wheelset_work_j)) Fail("replied wheelset_work_j that are not finite");
    std::copy(record.wheelset_work_j.begin(), record.wheelset_work_j.end(),
              reply.wheelset_work_j.begin() + static_cast<std::ptrdiff_t>(kWork) * rank_.first);
    Slides(record.slides, reply);
    auto from = record.details.begin();
    for (train_dynamics::WagonDetail& detail : reply.details) {
      if (detail.vehicle < rank_.first || detail.vehicle >= rank_.first + rank_.count) continue;
      if (from == record.details.end() || static_cast<int>(from->vehicle) != detail.vehicle + 1) {
        Fail(fmt::format("replied no details of vehicle {}", detail.vehicle + 1));
      }
      const train_brake_msgs::WagonState& message = *from++;
      train_brake_msgs::MessageToDetail(message, detail);
      if (!moved) continue;
      train_brake_msgs::ForEachField(detail, message, [&](const auto& values, const auto&) {
        if (AllFinite(values)) return;
        Fail(fmt::format("replied details of vehicle {} that are not finite", detail.vehicle + 1));
      });
    }
  }

  /// Completes the record of external vehicles: values that their node omits follow from the coupler heads, or are NaN;
  /// the digest covers the heads and the node's own data.
  /// @param start_m  [vehicle of the train] centre along the track
  void ExternalRecord(const train_brake_msgs::RankRecord& record, const std::vector<double>& start_m,
                      ExchangeReply& reply) const {
    const auto never = [](std::size_t) { return false; };
    train_dynamics::ForEachRecordField(
        [&](const RecordInfo& field, const auto& from, auto& to) {
          if (!from.empty()) return Copy(field, from, never, to);
          const auto begin = to.begin() + static_cast<std::ptrdiff_t>(rank_.first) * field.numbers;
          std::fill_n(begin, Count() * field.numbers, std::numeric_limits<double>::quiet_NaN());
        },
        record, reply);
    if (!record.state_digest.empty()) CheckSize("state_digest", record.state_digest.size(), Count());
    for (std::size_t i = 0; i < Count(); ++i) {
      const std::size_t at = rank_.first + i;
      if (record.position_m.empty()) reply.position_m[at] = start_m[at] + reply.head_displacement_m[at];
      if (record.speed_mps.empty()) reply.speed_mps[at] = reply.head_velocity_mps[at];
      if (!std::isfinite(reply.position_m[at]) || !std::isfinite(reply.speed_mps[at]))
        Fail(fmt::format("replied position_m = {}, speed_mps = {} for vehicle {}", reply.position_m[at],
                         reply.speed_mps[at], at + 1));
      train_dynamics::Digest digest;
      digest.Add(reply.head_displacement_m[at]);
      digest.Add(reply.head_velocity_mps[at]);
      if (!record.state_digest.empty()) digest.Add(record.state_digest[i]);
      reply.state_digest[at] = digest.value();
    }
  }

  /// @param numbers  of slides, one behind the other
  void Slides(const std::vector<double>& numbers, ExchangeReply& reply) const {
    using train_dynamics::kSlideNumbers;
    if (numbers.size() % kSlideNumbers != 0 || !AllFinite(numbers)) Fail("replied with malformed slides");
    for (std::size_t at = 0; at < numbers.size(); at += kSlideNumbers) {
      train_dynamics::SlideEvent slide;
      std::copy_n(&numbers[at], kSlideNumbers, reinterpret_cast<double*>(&slide));
      if (!(slide.vehicle > rank_.first && slide.vehicle <= rank_.first + rank_.count)) {
        Fail(fmt::format("replied a slide of vehicle {}, which it does not have", slide.vehicle));
      }
      reply.slides.push_back(slide);
    }
  }

  void Energies(const train_brake_msgs::RankRecord& record, ExchangeReply& reply) const {
    train_dynamics::ForEachEnergy(
        [&](const train_dynamics::FieldInfo& field, const auto& energies) {
          CheckSize(field.name, energies.size(), Count() * field.numbers);
          if (!AllFinite(energies)) Fail("replied energies that are not finite");
        },
        record);
    for (std::size_t i = 0; i < Count(); ++i) {
      reply.energy[rank_.first + i] = train_dynamics::GetEnergy(i, record);
    }
  }

  /// @param vehicles  of the train
  void Snapshot(std::uint64_t exchange, const std::vector<std::uint8_t>& bytes, std::size_t vehicles,
                ExchangeReply& reply) const {
    reply.snapshot.resize(vehicles);
    if (rank_.is_external) {
      if (bytes.empty()) Fail("replied an empty snapshot");
      reply.snapshot[rank_.first] = RowOf(bytes);
      return;
    }
    train_dynamics::BlockSnapshot part;
    try {
      part = train_dynamics::DecodeBlockSnapshot(bytes);
    } catch (const train_dynamics::SnapshotError& e) {
      Fail(fmt::format("replied a snapshot that {}", e.what()));
    }
    if (part.exchange != exchange || part.first != static_cast<std::uint64_t>(rank_.first) ||
        part.states.size() != Count()) {
      Fail("replied a snapshot of something else");
    }
    for (const StateRow& state : part.states) {
      if (!AllFinite(state)) Fail("replied a snapshot that is not finite");
    }
    std::move(part.states.begin(), part.states.end(), reply.snapshot.begin() + rank_.first);
  }

  /// @param vehicle  place in the train, from 1
  void CheckHosted(std::uint32_t vehicle) const {
    const auto first = static_cast<std::uint32_t>(rank_.first), count = static_cast<std::uint32_t>(rank_.count);
    if (vehicle > first && vehicle <= first + count) return;
    Fail(fmt::format("replied a fault of vehicle {}, which it does not have", vehicle));
  }

  [[noreturn]] void Fail(const std::string& what) const { throw RankFailure(rank_, when_, what); }

 private:
  std::size_t Count() const { return static_cast<std::size_t>(rank_.count); }

  /// @param is_computed  of vehicle i of the rank: whether its numbers must be finite
  template <class From, class IsComputed>
  void Copy(const RecordInfo& field, const From& from, const IsComputed& is_computed, std::vector<double>& to) const {
    const auto numbers = static_cast<std::size_t>(field.numbers);
    CheckSize(field.name, from.size(), Count() * numbers);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t vehicle = i / numbers;
      if (std::isfinite(from[i]) || !is_computed(vehicle)) continue;
      Fail(fmt::format("replied {} = {} for vehicle {}", field.name, from[i], rank_.first + 1 + vehicle));
    }
    std::copy(from.begin(), from.end(), to.begin() + rank_.first * field.numbers);
  }

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
      models_(scenario.VehicleModels()),
      gives_snapshots_(ranks.size(), true) {
  const train_dynamics::Consist consist(scenario.train);
  for (const double centre_m : consist.centre_m) start_m_.push_back(scenario.start_position_m + centre_m);
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
    if (!ranks[i].is_external) continue;
    for (int vehicle = ranks[i].first; vehicle < ranks[i].first + ranks[i].count; ++vehicle) {
      request.mass_kg.push_back(consist.vehicle(vehicle).TotalMass());
      request.length_m.push_back(consist.vehicle(vehicle).length_m);
      request.position_m.push_back(start_m_[vehicle]);
      request.speed_mps.push_back(scenario.InitialSpeedOfGroup(consist.vehicle_type[vehicle]));
    }
  }
}

void RankMessages::BeginAt(std::uint64_t exchange, const std::vector<StateRow>& snapshot) {
  if (!snapshot.empty()) train_dynamics::CheckRows(snapshot, static_cast<int>(models_.size()));
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    train_brake_msgs::ConfigureRequest& request = configure[i].request;
    request.exchange = exchange;
    request.snapshot.clear();
    if (snapshot.empty()) continue;
    if (ranks_[i].is_external) {
      request.snapshot = BytesOf(snapshot[ranks_[i].first]);
      continue;
    }
    train_dynamics::BlockSnapshot part;
    part.exchange = exchange;
    part.first = static_cast<std::uint64_t>(ranks_[i].first);
    const auto begin = snapshot.begin() + ranks_[i].first;
    part.states.assign(begin, begin + ranks_[i].count);
    request.snapshot = Encode(part);
  }
}

void RankMessages::Unpack(ExchangeReply& reply) {
  const std::string when = kConfiguration;
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    const train_brake_msgs::ConfigureResponse& response = configure[i].response;
    const Unpacker unpacker(ranks_[i], when);
    if (!response.ok) unpacker.Fail(response.message);
    unpacker.Reply(response, reply);
    gives_snapshots_[i] = response.gives_snapshots;
    if (ranks_[i].is_external) {
      unpacker.ExternalRecord(response.record, start_m_, reply);
    } else {
      unpacker.Record(response.record, models_, false, reply);
      unpacker.Energies(response.record, reply);
    }
  }
}

void RankMessages::Pack(const ExchangeRequest& whole) {
  for (std::size_t i = 0; i < ranks_.size(); ++i) Pack(whole, static_cast<int>(i), step[i].request);
}

void RankMessages::Pack(const ExchangeRequest& whole, int rank, train_brake_msgs::StepRequest& part) const {
  part.exchange = whole.exchange;
  part.dt_s = whole.dt_s;
  part.steps = static_cast<std::uint32_t>(whole.steps);
  part.record = whole.record;
  part.ledger = whole.ledger && !ranks_[rank].is_external;
  part.snapshot = whole.snapshot && gives_snapshots_[rank];
  part.friction_patches.clear();
  for (const train_dynamics::FrictionPatchParams& patch : whole.friction_patches) {
    for (const double number : {patch.from_m, patch.to_m, *patch.friction_coefficient})
      part.friction_patches.push_back(number);
  }
  train_dynamics::CopyLoads(whole, ranks_[rank].first, ranks_[rank].count, part);
}

void RankMessages::Unpack(const ExchangeRequest& whole, ExchangeReply& reply) const {
  const std::string when = ExchangeText(whole.exchange);
  reply.fault = {};
  if (whole.record && !ranks_.front().is_external) reply.slides.clear();
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
    unpacker.Reply(response, reply);
    if (whole.record && ranks_[i].is_external) {
      unpacker.ExternalRecord(response.record, start_m_, reply);
    } else if (whole.record) {
      unpacker.Record(response.record, models_, true, reply);
    }
    if (whole.ledger && !ranks_[i].is_external) unpacker.Energies(response.record, reply);
    if (whole.snapshot && gives_snapshots_[i])
      unpacker.Snapshot(whole.exchange + 1, response.snapshot, models_.size(), reply);
  }
}

}  // namespace ltd_master
