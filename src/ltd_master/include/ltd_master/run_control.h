#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>

namespace ltd_master {

/// Pause, resume and single steps of a run, asked for from other threads.
///
///   running --Pause--> paused --Resume--> running
///   paused  --Step(N)--> paused again N exchanges later
class RunControl {
 public:
  explicit RunControl(bool start_paused) : paused_(start_paused) {}

  void Pause();
  void Resume();
  /// Lets N exchanges happen and waits until they have. False if the run is not paused, or ends before.
  bool Step(std::uint64_t exchanges);
  bool paused() const;

  /// The run's side: waits while paused, for 0.1 s at most; true if the next exchange may happen.
  bool Admit();
  /// The run's side: an exchange has happened.
  void Completed();
  /// The run's side: no more exchanges will happen.
  void End();

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_;
  bool ended_ = false;
  std::uint64_t steps_left_ = 0;
};

/// Keeps a run to a multiple of real time.
class Pacer {
 public:
  /// @param real_time_factor  simulated over wall time; 0 = as fast as possible
  explicit Pacer(double real_time_factor) : factor_(real_time_factor) {}

  /// Sleeps until the wall clock has caught up with the simulated time; short enough that Ctrl-C stays quick.
  void Wait(double simulated_s);
  /// Forgets the time that has passed, as in a pause.
  void Restart(double simulated_s);

 private:
  using Clock = std::chrono::steady_clock;
  double factor_;
  bool started_ = false;
  double start_simulated_s_ = 0.0;
  Clock::time_point start_;
};

}  // namespace ltd_master
