#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

namespace ltd_master {

/// Pause, resume, single steps and the pace of a run, asked for from other threads.
///
///   running --Pause--> paused --Resume--> running
///   paused  --Step(N)--> paused again N exchanges later
class RunControl {
 public:
  /// @param real_time_factor  simulated over wall time to keep to; 0 = as fast as possible
  RunControl(bool start_paused, double real_time_factor)
      : paused_(start_paused), real_time_factor_(real_time_factor) {}

  void Pause();
  void Resume();
  /// Lets N exchanges happen and waits until they have. False if the run is not paused, or ends before.
  bool Step(std::uint64_t exchanges);
  /// @param factor  as in the constructor; holds from now on, whatever went before
  void SetRealTimeFactor(double factor);
  bool paused() const;
  double real_time_factor() const;

  /// The run's side: waits while paused or ahead of the pace, for 0.1 s at most, so that Ctrl-C stays quick.
  /// @return whether the next exchange, which begins at this simulated time, may happen
  bool Admit(double simulated_s);
  /// The run's side: an exchange has happened.
  void Completed();
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

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_;
  bool ended_ = false;
  std::uint64_t steps_left_ = 0;
  double real_time_factor_;
  std::optional<PaceMark> pace_mark_;  ///< none: the next exchange sets it
};

}  // namespace ltd_master
