#include "ltd_master/run_control.h"

#include <thread>

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

bool RunControl::paused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return paused_;
}

bool RunControl::Admit() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto admitted = [this] { return !paused_ || steps_left_ > 0; };
  return changed_.wait_for(lock, std::chrono::milliseconds(100), admitted);
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

void Pacer::Restart(double simulated_s) {
  start_simulated_s_ = simulated_s;
  start_ = Clock::now();
  started_ = true;
}

void Pacer::Wait(double simulated_s) {
  if (factor_ <= 0.0) return;
  if (!started_) Restart(simulated_s);
  const std::chrono::duration<double> due((simulated_s - start_simulated_s_) / factor_);
  std::this_thread::sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(due));
}

}  // namespace ltd_master
