#include "train_dynamics/train/thread_team.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>

namespace train_dynamics {
namespace {

using Clock = std::chrono::steady_clock;

/// About the time of a wake-up, and longer than the caller's work between two rounds.
constexpr std::chrono::microseconds kSpin{50};

template <class Condition>
bool Spin(const Condition& done) {
  constexpr int kLooks = 100;  // checks of the condition per check of the clock
  const Clock::time_point end = Clock::now() + kSpin;
  do {
    for (int i = 0; i < kLooks; ++i) {
      if (done()) return true;
    }
  } while (Clock::now() < end);
  return false;
}

}  // namespace

int UsableCores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(1, CPU_COUNT(&allowed));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // more cores than the set has room for
}

ThreadTeam::ThreadTeam(int size) : claims_(size) {
  try {
    for (int member = 1; member < size; ++member) threads_.emplace_back(&ThreadTeam::Work, this, member);
  } catch (const std::system_error& e) {
    End();
    throw std::system_error(e.code(), "cannot start " + std::to_string(size) + " threads");
  }
}

ThreadTeam::~ThreadTeam() { End(); }

void ThreadTeam::End() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
    ++round_;
  }
  start_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadTeam::Run(const std::function<void(int)>& task) {
  if (threads_.empty()) {
    task(0);
    return;
  }
  const Clock::time_point begin = Clock::now();
  if (faster_.way() == kTogether) {
    RunTogether(task);
  } else {
    for (int member = 0; member < static_cast<int>(claims_.size()); ++member) task(member);
  }
  faster_.Took(std::chrono::duration<double>(Clock::now() - begin).count());
}

void ThreadTeam::RunTogether(const std::function<void(int)>& task) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = &task;
    unfinished_ = static_cast<int>(claims_.size());
    ++round_;
    start_.notify_all();
  }
  for (int member = 0; member < static_cast<int>(claims_.size()); ++member) Take(member, round_);
  const auto finished = [this] { return unfinished_ == 0; };
  if (Spin(finished)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  finish_.wait(lock, finished);
}

void ThreadTeam::Take(int member, unsigned round) {
  unsigned before = round - 1;
  if (!claims_[member].round.compare_exchange_strong(before, round)) return;
  (*task_)(member);  // that of this round, which cannot end before
  if (--unfinished_ == 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    finish_.notify_one();
  }
}

void ThreadTeam::Work(int member) {
  unsigned seen = 0;
  while (true) {
    const auto called = [this, seen] { return round_ != seen; };
    if (!Spin(called)) {
      std::unique_lock<std::mutex> lock(mutex_);
      start_.wait(lock, called);
    }
    seen = round_;
    if (ending_) return;
    Take(member, seen);
  }
}

}  // namespace train_dynamics
