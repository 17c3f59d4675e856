#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "train_dynamics/train/train_master.h"

namespace train_results {

/// Runs a recorder in a thread of its own, so that a run does not wait for its files.
///
/// Records are copied into a queue and recorded in order; tasks between two records are executed there, too. When the
/// queue is full, the run waits: nothing is lost. The thread wakes for several records at once, or after 0.1 s, because
/// waking costs more than a record.
class RecorderThread {
 public:
  using Recorder = std::function<void(const train_dynamics::TrainRecord&)>;

  explicit RecorderThread(Recorder recorder);
  /// Finishes; exceptions are discarded.
  ~RecorderThread();

  /// An observer of the run's TrainMaster. @throws what the recorder or a task threw before
  void Record(const train_dynamics::TrainRecord& record);

  /// Executes a task after all records so far have been recorded, and before the next one. @throws as Record
  void Do(std::function<void()> task);
  /// Returns when all records and tasks are done. @throws what the recorder or a task threw, once
  void Finish();

 private:
  static constexpr std::uint64_t kQueue = 64;  ///< records
  static constexpr std::uint64_t kBatch = 16;  ///< that are worth a wake-up

  struct Entry {
    train_dynamics::TrainRecord record;
    std::function<void()> task;  ///< to do instead, unless it is empty
  };

  /// The next free entry; waits for one.
  Entry& Free();
  void Queue();
  void Work();

  Recorder recorder_;
  std::array<Entry, kQueue> queue_;  ///< entry n is in n % kQueue
  std::mutex mutex_;
  std::condition_variable work_, room_;
  std::uint64_t queued_ = 0, recorded_ = 0;  ///< so far
  bool ending_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace train_results
