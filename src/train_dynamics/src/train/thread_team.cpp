#include "train_dynamics/train/thread_team.h"

#include <sched.h>

#include <algorithm>
#include <string>
#include <system_error>

namespace train_dynamics {
namespace {

constexpr int kSpins = 100000;  // some 0.1 ms: longer than what the caller does between two rounds

template <class Condition>
bool Spin(const Condition& done) {
  for (int i = 0; i < kSpins; ++i) {
    if (done()) return true;
  }
  return false;
}

}  // namespace

int UsableCores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(1, CPU_COUNT(&allowed));
  return std::max(
      1, static_cast<int>(std::thread::hardware_concurrency()));  // more cores than the set has room for
}

ThreadTeam::ThreadTeam(int size) {
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
  if (!threads_.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = &task;
    unfinished_ = static_cast<int>(threads_.size());
    ++round_;
    start_.notify_all();
  }
  task(0);
  const auto finished = [this] { return unfinished_ == 0; };
  if (Spin(finished)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  finish_.wait(lock, finished);
}

void ThreadTeam::Work(int member) {
  unsigned seen = 0;
  while (true) {
    const auto called = [this, seen] { return round_ != seen; };
    if (!Spin(called)) {
      std::unique_lock<std::mutex> lock(mutex_);
      start_.wait(lock, called);
    }
    ++seen;
    if (ending_) return;
    (*task_)(member);
    if (--unfinished_ == 0) {
      const std::lock_guard<std::mutex> lock(mutex_);
      finish_.notify_one();
    }
  }
}

}  // namespace train_dynamics
