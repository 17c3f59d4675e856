#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace ltd_master {

/// Pause, resume, single steps and the pace of a run, asked for from other threads.
///
///   running --Pause--> paused --Resume--> running
///   paused  --Step(N)--> paused again N exchanges later, or sooner: Pause ends the steps, too
///
/// Replies say what is true when they are given: a pause is reported once the run stands still.
class RunControl {
 public:
  /// Whether a request was carried out, and a sentence on what became of it.
  struct Reply {
    bool success;
    std::string message;
  };

  /// @param real_time_factor  simulated over wall time to keep to; 0 = as fast as possible
  RunControl(bool start_paused, double real_time_factor) : paused_(start_paused), real_time_factor_(real_time_factor) {}

  /// Ends steps that are under way, and waits until the run stands still: for an exchange, and at most for `patience`.
  Reply Pause(std::chrono::milliseconds patience = std::chrono::seconds(5));
  Reply Resume();
  /// Lets N exchanges happen and waits until they have, or the run is paused anew, resumed or ended before.
  Reply Step(std::uint64_t exchanges);
  /// @param factor  as in the constructor; holds from now on, whatever went before
  Reply SetRealTimeFactor(double factor);
  bool paused() const;
  double real_time_factor() const;

  /// The run's side: waits while paused or ahead of the pace, for 0.1 s at most, so that Ctrl-C stays quick.
  /// @return whether the next exchange, which begins at this simulated time, may happen; Completed() follows then
  bool Admit(double simulated_s);
  /// The run's side: the exchange has happened, and the time is this now.
  void Completed(double simulated_s);
  /// The run's side: no more exchanges will happen.
  void End();

 private:
  using Clock = std::chrono::steady_clock;
  /// Where the wall clock stood at a simulated time: from here the pace is kept.
  struct PaceMark {
    double simulated_s;
    Clock::time_point wall;
  };

  Clock::time_point Due(double simulated_s);

  bool MayMove() const { return !paused_ || completed_ < goal_; }
  Reply Refusal() const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_;
  bool ended_ = false;
  bool is_moving_ = false;       ///< an exchange is under way
  double simulated_s_ = 0.0;     ///< at the end of the last exchange, or the beginning of the one under way
  std::uint64_t completed_ = 0;  ///< exchanges
  std::uint64_t goal_ = 0;       ///< a paused run goes on until `completed_` is this
  std::uint64_t decisions_ = 0;  ///< calls of Pause and Resume: each ends all steps
  double real_time_factor_;
  std::optional<PaceMark> pace_mark_;  ///< none: the next exchange sets it
};

}  // namespace ltd_master
