#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/train/driver_command.h"

namespace train_dynamics {

/// What conditions are judged by, at the start of an exchange.
struct Situation {
  std::uint64_t exchange = 0;
  double time_s = 0.0;
  double position_m = 0.0;  ///< of the first vehicle's centre, along the track
  double speed_mps = 0.0;   ///< of the vehicles' momentum, forward positive
};

/// A command that was given during the run, not by its time in the scenario.
struct GivenCommand {
  std::uint64_t exchange = 0;  ///< at whose start it was given
  DriverCommand command;
  bool is_live = false;  ///< it came from outside, and is in no scenario
};

/// Watches one condition, exchange by exchange.
class ConditionWatch {
 public:
  explicit ConditionWatch(const ConditionParams& condition) : condition_(condition) {}

  /// @return whether the condition held now or before, and its delay has passed
  bool Holds(const Situation& now);

  /// Calls function(number) for each number of its memory.
  template <class Function>
  void ForEachField(Function&& function) {
    function(is_watching_);
    function(from_m_);
    function(last_mps_);
    function(true_since_s_);
  }

 private:
  ConditionParams condition_;
  double is_watching_ = 0.0;    ///< 1: it has been looked at before
  double from_m_ = 0.0;         ///< where the first vehicle was when the watch began
  double last_mps_ = 0.0;       ///< at the exchange before
  double true_since_s_ = -1.0;  ///< < 0: it has not held yet
};

/// The driver's commands that are given while the train runs, and the end of the run.
///
/// A command with a condition is watched as soon as all commands before it in the list have been given: the list is
/// executed in order. Commands with a time wait for nothing, and are not part of this schedule: brake and locomotives
/// have them from the start. Patches of rail are given here, whatever their time. All conditions are judged at the
/// start of an exchange, so that what follows is the same for any number of threads, ranks and machines.
class CommandSchedule {
 public:
  /// @param until  where it holds, the run is to end; `standing` counts once the train has moved
  CommandSchedule(const std::vector<DriverCommand>& commands, const std::optional<ConditionParams>& until);

  /// Whether there is nothing to judge: no `until`, and every command has been given.
  bool IsDone() const;
  /// A command from outside, for the start of the next exchange.
  void Add(const DriverCommand& command) { live_.push_back(command); }

  /// Judges all conditions, and appends to `given` what is to be given now, in the order of the list, live ones last.
  void Judge(const Situation& now, std::vector<GivenCommand>& given);
  /// Takes note of a command that a built-in driver gives now, and appends it to `given`.
  void Give(const GivenCommand& command, std::vector<GivenCommand>& given);
  /// Whether `until` has come true.
  bool EndIsReached() const { return end_is_reached_ != 0.0; }

  /// All commands that have been given by conditions or from outside, in their order.
  const std::vector<GivenCommand>& Given() const { return given_; }

  /// The commands that still wait for a condition or an exchange, as sentences.
  std::vector<std::string> NotGiven() const;

  /// Saves the schedule's state as numbers, and restores it. @throws SnapshotError if the numbers do not fit this
  /// schedule
  std::vector<double> Memory() const;
  void SetMemory(const std::vector<double>& memory);

 private:
  struct Awaited {
    std::size_t index = 0;  ///< in the scenario's list
    DriverCommand command;
    std::optional<ConditionWatch> watch;
    std::optional<double> not_before_s;  ///< the latest time of the commands before it in the list
    double is_given = 0.0;
  };
  template <class Self, class Function>
  static void ForEachField(Self& self, Function&& function);

  std::vector<Awaited> commands_;
  std::optional<ConditionWatch> until_;
  bool until_stands_ = false;
  double has_moved_ = 0.0, end_is_reached_ = 0.0;
  std::vector<DriverCommand> live_;  ///< for the next exchange
  std::vector<GivenCommand> given_;
};

}  // namespace train_dynamics
