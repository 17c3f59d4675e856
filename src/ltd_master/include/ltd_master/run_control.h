#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace ltd_master {

/// Pause, resume, single steps and the pace of a run, requested by other threads.
///
///   running --Pause--> paused --Resume--> running
///   paused  --Step(N)--> paused again N exchanges later, or sooner: Pause ends the steps, too
///
/// Replies are true when they are given: a pause is reported once the run has stopped.
class RunControl {
 public:
  /// Whether a request was carried out, and a sentence on what became of it.
  struct Reply {
    bool success;
    std::string message;
  };

  /// @param real_time_factor  simulated over wall time to keep to; 0 = as fast as possible
  RunControl(bool start_paused, double real_time_factor) : paused_(start_paused), real_time_factor_(real_time_factor) {}

  /// Ends pending steps, and waits until the run has stopped: for an exchange, and at most for `patience`.
  Reply Pause(std::chrono::milliseconds patience = std::chrono::seconds(5));
  Reply Resume();
  /// Runs N exchanges and waits for their end, or until the run is paused again, resumed or ended.
  Reply Step(std::uint64_t exchanges);
  /// @param factor  as in the constructor; applies from now on
  Reply SetRealTimeFactor(double factor);
  bool paused() const;
  double real_time_factor() const;

  /// For the run: waits while paused or ahead of the pace, for 0.1 s at most, so that Ctrl-C acts quickly.
  /// @return whether the next exchange, which begins at this simulated time, may happen; Completed() follows then
  bool Admit(double simulated_s);
  /// For the run: the exchange is complete, and this is the simulated time.
  void Completed(double simulated_s);
  /// For the run: no more exchanges follow.
  void End();

 private:
  using Clock = std::chrono::steady_clock;
  /// The wall time at a simulated time, from which the pace is kept.
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
  std::uint64_t goal_ = 0;       ///< a paused run continues until `completed_` is this
  std::uint64_t decisions_ = 0;  ///< calls of Pause and Resume: each ends all steps
  double real_time_factor_;
  std::optional<PaceMark> pace_mark_;  ///< none: the next exchange sets it
};

}  // namespace ltd_master
