#include "ltd_master/live_commands.h"

#include <algorithm>
#include <stdexcept>

#include "train_dynamics/train/ranks.h"
#include "train_results/conversions.h"

namespace ltd_master {
namespace {

using train_dynamics::BrokenRule;
using train_dynamics::DriverCommand;

/// The rule that a command breaks in a train, as a sentence; empty: none.
std::string WhyNot(const DriverCommand& command, const train_dynamics::ScenarioParams& scenario) {
  if (command.IsOfRail()) {
    using train_dynamics::VehicleModel;
    if (!scenario.Uses(VehicleModel::kTwoD) && !scenario.adhesion_limit &&
        train_dynamics::ExternalRanks(scenario.train).empty())
      return "kind friction changes nothing: the ltd model leaves out the rail's friction without "
             "adhesion_limit";
  }
  if (!command.IsOfLocomotives() && !command.IsOfRail() && !scenario.pressure_table.empty())
    return "the pressures of the brake come from pressure_table: it obeys no command";
  const std::vector<BrokenRule> broken =
      command.IsOfRail() ? train_dynamics::JudgePatch(command.OfRail(), "command", scenario.track)
      : command.IsOfLocomotives()
          ? train_dynamics::JudgeLocomotiveCommand(command.OfLocomotives(0.0), "command", scenario.train)
      : command.IsOfLocomotiveBrakes()
          ? train_dynamics::JudgeLocomotiveBrakeCommand(command.OfLocomotiveBrakes(0.0), "command", scenario.train,
                                                        *scenario.brake)
          : scenario.brake->BrokenRules({command.OfBrake(0.0)}, scenario.train.VehicleCount());
  if (broken.empty()) return "";
  const std::string& key = broken.front().key;  // "commands[0].reduction_kpa", "command.notch"
  return key.substr(key.find('.') + 1) + " " + broken.front().text;
}

}  // namespace

DriverCommand LiveCommands::Judge(const train_brake_msgs::DriverCommand& message, std::uint64_t exchange) const {
  DriverCommand command =
      train_dynamics::WithVehicles({train_results::CommandOf(message, exchange)}, scenario_.train).front();
  if (!command.group.empty()) {
    throw std::invalid_argument("group " + train_dynamics::RuleOfGroup(command, scenario_.train) + ", got '" +
                                command.group + "'");
  }
  const std::string why_not = WhyNot(command, scenario_);
  if (!why_not.empty()) throw std::invalid_argument(why_not);
  return command;
}

std::uint64_t LiveCommands::Receive(const train_brake_msgs::DriverCommand& message) {
  const DriverCommand command = Judge(message, 0);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (command.IsOfRail()) {
    if (patches_ >= train_dynamics::kMostPatchesOnTheWay)
      throw std::invalid_argument("kind " + train_dynamics::RuleOfPatches());
    ++patches_;
  }
  received_.push_back({command, next_exchange_});
  return next_exchange_;
}

std::vector<DriverCommand> LiveCommands::Take(std::uint64_t exchange, std::size_t patches) {
  const std::lock_guard<std::mutex> lock(mutex_);
  patches_ = patches;
  if (next_exchange_ == 0) {  // a resumed run begins later
    for (Received& received : received_) received.exchange = exchange;
  }
  next_exchange_ = exchange + 1;  // later commands miss this exchange
  if (received_.empty()) return {};
  std::vector<DriverCommand> due;
  for (const Received& received : received_) {
    due.push_back(received.command);
    patches_ += received.command.IsOfRail() ? 1 : 0;
    largest_latency_ = std::max(largest_latency_, exchange - received.exchange);
    ++count_;
  }
  received_.clear();
  return due;
}

std::uint64_t LiveCommands::largest_latency() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return largest_latency_;
}

std::uint64_t LiveCommands::count() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return count_;
}

}  // namespace ltd_master
