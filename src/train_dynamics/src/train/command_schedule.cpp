#include "train_dynamics/train/command_schedule.h"

#include <algorithm>
#include <cmath>

#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {
namespace {

constexpr double kStandingMps = 1e-3;
constexpr double kKmhPerMps = 3.6;

}  // namespace

bool ConditionWatch::Holds(const Situation& now) {
  if (is_watching_ == 0.0) {
    is_watching_ = 1.0;
    from_m_ = now.position_m;
    last_mps_ = now.speed_mps;
  }
  const double speed_kmh = kKmhPerMps * std::abs(now.speed_mps);
  const ConditionParams& c = condition_;
  bool holds = true;
  if (c.position_m) holds = holds && (from_m_ - *c.position_m) * (now.position_m - *c.position_m) <= 0.0;
  if (c.speed_above_kmh) holds = holds && speed_kmh > *c.speed_above_kmh;
  if (c.speed_below_kmh) holds = holds && speed_kmh < *c.speed_below_kmh;
  if (c.standing) holds = holds && (std::abs(now.speed_mps) <= kStandingMps || last_mps_ * now.speed_mps < 0.0);
  last_mps_ = now.speed_mps;
  if (holds && true_since_s_ < 0.0) true_since_s_ = now.time_s;
  return true_since_s_ >= 0.0 && now.time_s >= true_since_s_ + c.delay_s;
}

CommandSchedule::CommandSchedule(const std::vector<DriverCommand>& commands,
                                 const std::optional<ConditionParams>& until) {
  std::optional<double> latest_s;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const DriverCommand& command = commands[i];
    if (command.time_s && !command.IsOfRail()) {
      latest_s = std::max(latest_s.value_or(0.0), *command.time_s);
      continue;
    }
    Awaited awaited;
    awaited.index = i;
    awaited.command = command;
    if (command.when) awaited.watch.emplace(*command.when);
    awaited.not_before_s = latest_s;
    commands_.push_back(awaited);
  }
  if (!until) return;
  until_.emplace(*until);
  until_stands_ = until->standing;
}

bool CommandSchedule::IsDone() const {
  return !until_ && live_.empty() && std::all_of(commands_.begin(), commands_.end(), [](const Awaited& awaited) {
    return awaited.is_given != 0.0;
  });
}

void CommandSchedule::Judge(const Situation& now, std::vector<GivenCommand>& given) {
  const auto give = [&](const DriverCommand& command, bool is_live) { Give({now.exchange, command, is_live}, given); };
  bool all_before_are_given = true;
  for (Awaited& awaited : commands_) {
    if (awaited.is_given == 0.0) {
      const bool is_due = awaited.watch ? all_before_are_given && now.time_s >= awaited.not_before_s.value_or(0.0) &&
                                              awaited.watch->Holds(now)
                          : awaited.command.time_s ? now.time_s >= *awaited.command.time_s
                                                   : static_cast<double>(now.exchange) >= *awaited.command.exchange;
      if (is_due) {
        awaited.is_given = 1.0;
        give(awaited.command, false);
      }
    }
    all_before_are_given = all_before_are_given && awaited.is_given != 0.0;
  }
  for (const DriverCommand& command : live_) give(command, true);
  live_.clear();
  if (std::abs(now.speed_mps) > kStandingMps) has_moved_ = 1.0;
  if (until_ && (has_moved_ != 0.0 || !until_stands_) && until_->Holds(now)) end_is_reached_ = 1.0;
}

void CommandSchedule::Give(const GivenCommand& command, std::vector<GivenCommand>& given) {
  given.push_back(command);
  given_.push_back(command);
}

std::vector<std::string> CommandSchedule::NotGiven() const {
  std::vector<std::string> sentences;
  for (const Awaited& awaited : commands_) {
    if (awaited.is_given != 0.0) continue;
    sentences.push_back("commands[" + std::to_string(awaited.index) + "] (" + awaited.command.Text() +
                        ") was not given: " +
                        (awaited.watch            ? "its condition did not come true"
                         : awaited.command.time_s ? "the run ended before its time"
                                                  : "the run ended before its exchange"));
  }
  return sentences;
}

template <class Self, class Function>
void CommandSchedule::ForEachField(Self& self, Function&& function) {
  for (auto& awaited : self.commands_) {
    function(awaited.is_given);
    if (awaited.watch) awaited.watch->ForEachField(function);
  }
  function(self.has_moved_);
  function(self.end_is_reached_);
  if (self.until_) self.until_->ForEachField(function);
}

std::vector<double> CommandSchedule::Memory() const {
  CommandSchedule copy = *this;  // the list of fields is written for changing them, too
  MemoryWriter memory;
  ForEachField(copy, memory);
  memory(static_cast<double>(given_.size()));
  for (const GivenCommand& given : given_) {
    memory(static_cast<double>(given.exchange));
    memory(given.is_live ? 1.0 : 0.0);
    memory(static_cast<double>(given.command.kind));
    memory(given.command.reduction_kpa);
    memory(given.command.notch);
    memory(given.command.pressure_kpa);
    if (given.command.IsOfRail()) {
      memory(given.command.from_m);
      memory(given.command.to_m);
      memory(given.command.friction_coefficient);
    }
    memory(static_cast<double>(given.command.vehicles.size()));
    for (int vehicle : given.command.vehicles) memory(vehicle);
  }
  return memory.Take();
}

void CommandSchedule::SetMemory(const std::vector<double>& memory) {
  MemoryReader reader(memory);
  ForEachField(*this, reader);
  const auto next = [&reader] {
    double number = 0.0;
    reader(number);
    return number;
  };
  given_.clear();
  for (double left = next(); left > 0.0; left -= 1.0) {
    GivenCommand given;
    given.exchange = static_cast<std::uint64_t>(next());
    given.is_live = next() != 0.0;
    given.command.kind = static_cast<DriverCommandKind>(static_cast<int>(next()));
    given.command.reduction_kpa = next();
    given.command.notch = next();
    given.command.pressure_kpa = next();
    if (given.command.IsOfRail()) {
      given.command.from_m = next();
      given.command.to_m = next();
      given.command.friction_coefficient = next();
    }
    given.command.exchange = static_cast<double>(given.exchange);
    for (double vehicles = next(); vehicles > 0.0; vehicles -= 1.0)
      given.command.vehicles.push_back(static_cast<int>(next()));
    given_.push_back(given);
  }
  reader.End();
}

}  // namespace train_dynamics
