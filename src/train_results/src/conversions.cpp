#include "train_results/conversions.h"

#include <fmt/format.h>
#include <train_brake_msgs/wagon_detail.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "strict_config/writer.h"

namespace train_results {
namespace {

using train_dynamics::TrainRecord;

template <class Message>
void Stamp(const TrainRecord& record, Message& message) {
  message.header.stamp.fromSec(record.time_s);
  message.exchange = record.exchange;
}

template <class From, class To>
void Copy(const From& from, To& to) {
  to.resize(from.size());
  std::transform(from.begin(), from.end(), to.begin(),
                 [](auto value) { return static_cast<typename To::value_type>(value); });
}

template <class From, class To>
void Copy(const std::vector<From>& from, ArrayView<To, From>& to) {
  View(from, to);
}

void CopyForces(const TrainRecord& record, std::vector<float>& to) {
  const std::vector<double>& force_n = record.held.coupler_force_n;
  to.resize(record.coupler_extension_m.size());
  for (std::size_t c = 0; c < to.size(); ++c) to[c] = static_cast<float>(force_n[c + 1]);
}
void CopyForces(const TrainRecord& record, ArrayView<float>& to) {
  to = {record.held.coupler_force_n.data() + 1, record.coupler_extension_m.size()};
}

// Of a message or its view.

template <class State>
void ConvertState(const TrainRecord& record, State& message) {
  Stamp(record, message);
  train_dynamics::ForEachRecordField(
      [](const train_dynamics::RecordInfo&, const auto& from, auto& to) { Copy(from, to); }, record.vehicles, message);
  Copy(record.acceleration_mps2, message.acceleration_mps2);
  Copy(record.vehicles.state_digest, message.vehicle_digest);
  message.state_digest = record.state_digest;
}

template <class Forces>
void ConvertForces(const TrainRecord& record, Forces& message) {
  Stamp(record, message);
  CopyForces(record, message.coupler_force_n);
  Copy(record.coupler_extension_m, message.coupler_extension_m);
}

template <class Pressures>
void ConvertPressures(const TrainRecord& record, Pressures& message) {
  Stamp(record, message);
  Copy(record.cylinder_pressure_pa, message.cylinder_pressure_pa);
  train_dynamics::ForEachBrakeField([](const char*, const auto& from, auto& to) { Copy(from, to); }, record.brake,
                                    message);
}

}  // namespace

void Convert(const TrainRecord& record, train_brake_msgs::TrainState& message) { ConvertState(record, message); }
void Convert(const TrainRecord& record, TrainStateView& view) { ConvertState(record, view); }
void Convert(const TrainRecord& record, train_brake_msgs::InTrainForces& message) { ConvertForces(record, message); }
void Convert(const TrainRecord& record, InTrainForcesView& view) { ConvertForces(record, view); }
void Convert(const TrainRecord& record, train_brake_msgs::BrakePressures& message) {
  ConvertPressures(record, message);
}
void Convert(const TrainRecord& record, BrakePressuresView& view) { ConvertPressures(record, view); }

void Convert(const TrainRecord& record, train_brake_msgs::Slides& message) {
  Stamp(record, message);
  train_dynamics::ForEachSlideField([](const char*, const char*, auto& numbers) { numbers.clear(); }, message);
  for (const train_dynamics::SlideEvent& slide : record.slides) {
    train_dynamics::ForEachSlideField(
        [](const char*, const char*, const double& number, auto& numbers) {
          numbers.push_back(static_cast<typename std::decay_t<decltype(numbers)>::value_type>(number));
        },
        slide, message);
  }
}

void Convert(const TrainRecord& record, train_brake_msgs::EnergyLedger& message) {
  const train_dynamics::EnergyLedger& ledger = *record.ledger;
  const double initial_j = record.at_time_zero.stored_energy_j;
  Stamp(record, message);
  message.element.clear();
  message.dissipated_j.clear();
  for (const auto& [element, energy] : ledger.dissipated_j) {
    message.element.push_back(element);
    message.dissipated_j.push_back(energy);
  }
  message.initial_j = initial_j;
  message.kinetic_j = ledger.kinetic_j;
  message.potential_j = ledger.potential_j;
  message.gravity_work_j = ledger.gravity_work_j;
  message.traction_work_j = ledger.traction_work_j;
  message.residual_j = ledger.Residual(initial_j);
}

void Convert(const TrainRecord& record, const train_dynamics::WagonDetail& detail,
             train_brake_msgs::WagonState& message) {
  Stamp(record, message);
  message.vehicle = static_cast<std::uint32_t>(detail.vehicle + 1);
  train_brake_msgs::DetailToMessage(detail, message);
  message.front_coupler_force_n = static_cast<float>(record.held.coupler_force_n[detail.vehicle]);
  message.rear_coupler_force_n = static_cast<float>(record.held.coupler_force_n[detail.vehicle + 1]);
  message.cylinder_pressure_pa = static_cast<float>(record.held.cylinder_pressure_pa[detail.vehicle]);
}

void Convert(const train_dynamics::GivenCommand& given, double time_s, train_brake_msgs::GivenCommand& message) {
  message.header.stamp.fromSec(time_s);
  message.exchange = given.exchange;
  message.command.kind = train_dynamics::NameOf(given.command.kind);
  const bool applies = given.command.kind == train_dynamics::DriverCommandKind::kApply;
  message.command.reduction_kpa = applies ? given.command.reduction_kpa : 0.0;
  message.command.notch = given.command.IsOfLocomotives() ? given.command.notch : 0.0;
  const bool is_independent = given.command.kind == train_dynamics::DriverCommandKind::kIndependentBrake;
  message.command.pressure_kpa = is_independent ? given.command.pressure_kpa : 0.0;
  const bool is_of_rail = given.command.IsOfRail();
  message.command.from_m = is_of_rail ? given.command.from_m : 0.0;
  message.command.to_m = is_of_rail ? given.command.to_m : 0.0;
  message.command.friction_coefficient = is_of_rail ? given.command.friction_coefficient : 0.0;
  message.command.vehicles.assign(given.command.vehicles.begin(), given.command.vehicles.end());
  message.live = given.is_live;
}

void Convert(const train_dynamics::DriverView& view, train_brake_msgs::DriverView& message) {
  message.exchange = view.exchange;
  message.time_s = view.time_s;
  message.position_m = view.position_m;
  message.front_m = view.front_m;
  message.rear_m = view.rear_m;
  message.speed_mps = view.speed_mps;
  message.speed_limit_mps = view.speed_limit_mps;
  message.mean_grade = view.mean_grade;
  const auto split = [](const std::vector<train_dynamics::PlaceAhead>& places, auto& from_m, auto& values) {
    from_m.clear();
    values.clear();
    for (const train_dynamics::PlaceAhead& place : places) {
      from_m.push_back(place.from_m);
      values.push_back(place.value);
    }
  };
  split(view.limits_ahead, message.limit_from_m, message.limit_mps);
  split(view.grades_ahead, message.grade_from_m, message.grade);
  message.station_m.clear();
  message.station.clear();
  for (const train_dynamics::StationParams& station : view.stations_ahead) {
    message.station_m.push_back(station.position_m);
    message.station.push_back(station.name);
  }
  message.throttle_notch = view.throttle_notch;
  message.dynamic_brake_notch = view.dynamic_brake_notch;
  message.effort_n = view.effort_n;
  message.reduction_kpa = view.reduction_kpa;
  message.emergency = view.emergency;
  message.brake_pipe_kpa = view.brake_pipe_kpa;
  message.cylinder_kpa = view.cylinder_kpa;
  message.mean_cylinder_kpa = view.mean_cylinder_kpa;
  message.coupler_force_n = view.coupler_force_n;
}

train_dynamics::DriverCommand CommandOf(const train_brake_msgs::DriverCommand& message, std::uint64_t exchange) {
  train_dynamics::DriverCommand command;
  command.exchange = static_cast<double>(exchange);
  std::string known;
  bool is_known = false;
  for (const auto& [name, kind] : train_dynamics::kDriverCommandKinds) {
    known += (known.empty() ? "" : ", ") + std::string(name);
    if (message.kind != name) continue;
    is_known = true;
    command.kind = kind;
  }
  if (!is_known) throw std::invalid_argument("kind must be one of " + known + ", got '" + message.kind + "'");
  if (command.kind == train_dynamics::DriverCommandKind::kApply) {
    if (!(std::isfinite(message.reduction_kpa) && message.reduction_kpa > 0.0))
      throw std::invalid_argument(fmt::format("reduction_kpa must be > 0, got {}", message.reduction_kpa));
    command.reduction_kpa = message.reduction_kpa;
  }
  if (command.IsOfLocomotives()) {
    if (!(std::isfinite(message.notch) && message.notch >= 0.0))
      throw std::invalid_argument(fmt::format("notch must be >= 0, got {}", message.notch));
    command.notch = message.notch;
  }
  if (command.kind == train_dynamics::DriverCommandKind::kIndependentBrake) {
    if (!(std::isfinite(message.pressure_kpa) && message.pressure_kpa >= 0.0))
      throw std::invalid_argument(fmt::format("pressure_kpa must be >= 0, got {}", message.pressure_kpa));
    command.pressure_kpa = message.pressure_kpa;
  }
  if (command.IsOfRail()) {
    for (const auto& [name, at_m] : {std::pair{"from_m", message.from_m}, std::pair{"to_m", message.to_m}}) {
      if (!std::isfinite(at_m)) throw std::invalid_argument(fmt::format("{} must be finite, got {}", name, at_m));
    }
    if (message.from_m >= message.to_m)
      throw std::invalid_argument(
          fmt::format("to_m must be greater than from_m, {}, got {}", message.from_m, message.to_m));
    if (!(message.friction_coefficient > 0.0 && message.friction_coefficient <= 1.0))
      throw std::invalid_argument(
          fmt::format("friction_coefficient must be > 0 and <= 1, got {}", message.friction_coefficient));
    command.from_m = message.from_m;
    command.to_m = message.to_m;
    command.friction_coefficient = message.friction_coefficient;
  }
  if (command.IsOfLocomotives() || command.IsOfLocomotiveBrakes()) {
    command.vehicles.assign(message.vehicles.begin(), message.vehicles.end());
    command.group = message.group;
    if (!command.group.empty() && !command.vehicles.empty())
      throw std::invalid_argument("group must not stand beside vehicles");
  }
  return command;
}

std::string VersionLine() { return "# train_brake " TRAIN_BRAKE_VERSION; }

std_msgs::String ScenarioMessage(const train_dynamics::ScenarioParams& scenario) {
  std_msgs::String message;
  message.data = VersionLine() + "\n" + strict_config::Write(scenario);
  return message;
}

}  // namespace train_results
