#include "ltd_master/run_control.h"

#include <algorithm>

namespace ltd_master {

void RunControl::Pause() {
  const std::lock_guard<std::mutex> lock(mutex_);
  paused_ = true;
}

void RunControl::Resume() {
  const std::lock_guard<std::mutex> lock(mutex_);
  paused_ = false;
  steps_left_ = 0;
  changed_.notify_all();
}

bool RunControl::Step(std::uint64_t exchanges) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!paused_ || ended_) return false;
  steps_left_ += exchanges;
  changed_.notify_all();
  changed_.wait(lock, [this] { return steps_left_ == 0 || ended_; });
  return steps_left_ == 0;
}

void RunControl::SetRealTimeFactor(double factor) {
  const std::lock_guard<std::mutex> lock(mutex_);
  real_time_factor_ = factor;
  pace_mark_.reset();
  changed_.notify_all();
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
  const Clock::time_point patience = Clock::now() + std::chrono::milliseconds(100);
  while (true) {
    const bool may_move = !paused_ || steps_left_ > 0;
    if (!may_move) pace_mark_.reset();  // a pause is not made up for
    const Clock::time_point due = may_move ? Due(simulated_s) : Clock::time_point::max();
    const Clock::time_point now = Clock::now();
    if (due <= now) return true;
    if (patience <= now) return false;
    changed_.wait_until(lock, std::min(due, patience));
  }
}

void RunControl::Completed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (steps_left_ > 0 && --steps_left_ == 0) changed_.notify_all();
}

void RunControl::End() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

}  // namespace ltd_master
