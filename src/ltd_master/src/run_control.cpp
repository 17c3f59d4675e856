#include "ltd_master/run_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace ltd_master {

RunControl::Reply RunControl::Refusal() const {
  return {false, ended_ ? fmt::format("the run has ended, at {:.3f} s", simulated_s_) : "the train is not paused"};
}

RunControl::Reply RunControl::Pause(std::chrono::milliseconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (ended_) return Refusal();
  const bool stood_still = paused_ && !MayMove() && !is_moving_;
  paused_ = true;
  goal_ = completed_;
  const std::uint64_t mine = ++decisions_;
  changed_.notify_all();
  changed_.wait_for(lock, patience, [&] { return !is_moving_ || ended_ || decisions_ != mine; });
  if (ended_) return Refusal();
  if (decisions_ != mine && !paused_) return {false, fmt::format("resumed again, near {:.3f} s", simulated_s_)};
  if (is_moving_) {
    return {true, fmt::format("pauses after the exchange that began at {:.3f} s and is still under way", simulated_s_)};
  }
  return {true, fmt::format("{} at {:.3f} s", stood_still ? "was paused already," : "paused", simulated_s_)};
}

RunControl::Reply RunControl::Resume() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!paused_ || ended_) return Refusal();
  paused_ = false;
  goal_ = completed_;
  ++decisions_;
  changed_.notify_all();
  return {true, fmt::format("resumed at {:.3f} s", simulated_s_)};
}

RunControl::Reply RunControl::Step(std::uint64_t exchanges) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!paused_ || ended_) return Refusal();
  const std::uint64_t begin = std::max(completed_, goal_);  // behind the steps of others
  const std::uint64_t end = begin + std::min(exchanges, std::numeric_limits<std::uint64_t>::max() - begin);
  goal_ = end;
  const std::uint64_t decisions = decisions_;
  changed_.notify_all();
  // A pause ends the steps once the run has stopped, a resumption at once.
  changed_.wait(lock,
                [&] { return completed_ >= end || ended_ || (decisions_ != decisions && !(paused_ && is_moving_)); });
  if (completed_ >= end) return {true, ""};
  const std::uint64_t done = completed_ > begin ? completed_ - begin : 0;
  return {false, fmt::format("{} after {} of {} exchanges, at {:.3f} s",
                             ended_    ? "the run has ended"
                             : paused_ ? "paused"
                                       : "resumed",
                             done, exchanges, simulated_s_)};
}

RunControl::Reply RunControl::SetRealTimeFactor(double factor) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ended_) return Refusal();
  real_time_factor_ = factor;
  pace_mark_.reset();
  changed_.notify_all();
  return {true, factor > 0.0 ? fmt::format("{:g} times real time", factor) : "as fast as possible"};
}

bool RunControl::paused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return paused_;
}

double RunControl::real_time_factor() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return real_time_factor_;
}

RunControl::Clock::time_point RunControl::Due(double simulated_s) {
  constexpr double kForEver = 1e9;  // [s] that the clock can still count
  if (real_time_factor_ <= 0.0) return Clock::time_point::min();
  if (!pace_mark_) pace_mark_ = PaceMark{simulated_s, Clock::now()};
  const std::chrono::duration<double> after(
      std::min((simulated_s - pace_mark_->simulated_s) / real_time_factor_, kForEver));
  return pace_mark_->wall + std::chrono::duration_cast<Clock::duration>(after);
}

bool RunControl::Admit(double simulated_s) {
  std::unique_lock<std::mutex> lock(mutex_);
  simulated_s_ = simulated_s;
  const Clock::time_point patience = Clock::now() + std::chrono::milliseconds(100);
  while (true) {
    const bool may_move = MayMove();
    if (!may_move) pace_mark_.reset();  // time lost in a pause is not caught up
    const Clock::time_point due = may_move ? Due(simulated_s) : Clock::time_point::max();
    const Clock::time_point now = Clock::now();
    if (due <= now) {
      is_moving_ = true;
      return true;
    }
    if (patience <= now) return false;
    changed_.wait_until(lock, std::min(due, patience));
  }
}

void RunControl::Completed(double simulated_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_moving_ = false;
  simulated_s_ = simulated_s;
  ++completed_;
  if (paused_) changed_.notify_all();
}

void RunControl::End() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

}  // namespace ltd_master
