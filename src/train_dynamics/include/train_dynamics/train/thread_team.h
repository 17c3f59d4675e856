#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace train_dynamics {

/// The cores that this process may use, at least 1: those of the machine, or fewer (taskset, a batch system).
int UsableCores();

/// A fixed team of threads that runs the same task side by side, thousands of times a second.
///
/// Waiting spins for about 0.1 ms, then sleeps, so that neither a busy train nor an idle one wastes a
/// core.
class ThreadTeam {
 public:
  /// @param size  the caller's thread included, >= 1
  /// @throws std::system_error if the system gives no more threads
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /// Runs task(0) ... task(size - 1), task(0) in the calling thread, and returns when all are done. Tasks do
  /// not throw.
  void Run(const std::function<void(int)>& task);

 private:
  void Work(int member);
  void End();

  const std::function<void(int)>* task_ = nullptr;
  std::atomic<unsigned> round_{0};  ///< raised by one to start a round
  std::atomic<int> unfinished_{0};  ///< members that have not finished the round
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  std::condition_variable start_, finish_;
  std::vector<std::thread> threads_;
};

}  // namespace train_dynamics
