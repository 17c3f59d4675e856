#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "train_dynamics/train/faster_way.h"

namespace train_dynamics {

/// The cores that this process may use, at least 1: those of the machine, or fewer (taskset, a batch system).
int UsableCores();

/// A fixed team of threads that runs the same task side by side, thousands of times a second; or, where that takes
/// longer because the machine has other work, one after the other in the calling thread (see FasterWay). When the
/// caller has done its own part, it also does the parts that threads have not begun because they wait for a core.
///
/// Waiting spins for as long as it takes to wake a thread, then sleeps, so that neither a busy train nor an idle one
/// wastes a core.
class ThreadTeam {
 public:
  /// @param size  the caller's thread included, >= 1
  /// @throws std::system_error if the system gives no more threads
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /// Runs task(0) ... task(size - 1), each of them once, and returns when all are done. Tasks do not throw.
  void Run(const std::function<void(int)>& task);

 private:
  static constexpr int kTogether = 0;  ///< a way; the other: alone

  /// Which thread takes the task of a member in each round.
  struct alignas(64) Claim {
    std::atomic<unsigned> round{0};  ///< the last one in which a thread took it
  };

  void RunTogether(const std::function<void(int)>& task);
  /// Does the task of a member, unless a thread has taken it.
  void Take(int member, unsigned round);
  void Work(int member);
  void End();

  FasterWay faster_;
  const std::function<void(int)>* task_ = nullptr;
  std::atomic<unsigned> round_{0};  ///< raised by one to start a round
  std::atomic<int> unfinished_{0};  ///< tasks of the round that are not finished
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  std::condition_variable start_, finish_;
  std::vector<Claim> claims_;  ///< [member]
  std::vector<std::thread> threads_;
};

}  // namespace train_dynamics
