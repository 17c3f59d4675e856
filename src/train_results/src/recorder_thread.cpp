#include "train_results/recorder_thread.h"

#include <chrono>
#include <utility>

namespace train_results {

RecorderThread::RecorderThread(Recorder recorder)
    : recorder_(std::move(recorder)), thread_(&RecorderThread::Work, this) {}

RecorderThread::~RecorderThread() {
  try {
    Finish();
  } catch (const std::exception&) {  // an unwinding caller has the first error already
  }
}

RecorderThread::Entry& RecorderThread::Free() {
  std::unique_lock<std::mutex> lock(mutex_);
  room_.wait(lock, [this] { return queued_ - recorded_ < kQueue || error_ != nullptr; });
  if (error_ != nullptr) std::rethrow_exception(error_);
  return queue_[queued_ % kQueue];
}

void RecorderThread::Queue() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++queued_;
  if (queued_ - recorded_ == kBatch) work_.notify_one();
}

void RecorderThread::Record(const train_dynamics::TrainRecord& record) {
  Free().record = record;
  Queue();
}

void RecorderThread::Do(std::function<void()> task) {
  Free().task = std::move(task);
  Queue();
}

void RecorderThread::Finish() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  work_.notify_one();
  thread_.join();
  if (error_ != nullptr) std::rethrow_exception(error_);
}

void RecorderThread::Work() {
  constexpr std::chrono::milliseconds kPatience{100};
  std::unique_lock<std::mutex> lock(mutex_);
  while (error_ == nullptr && !(ending_ && recorded_ == queued_)) {
    work_.wait_for(lock, kPatience, [this] { return ending_ || queued_ - recorded_ >= kBatch; });
    const std::uint64_t end = queued_;
    std::uint64_t next = recorded_;
    std::exception_ptr error;
    lock.unlock();
    try {
      for (; next != end; ++next) {
        Entry& entry = queue_[next % kQueue];
        if (entry.task) {
          std::exchange(entry.task, {})();
        } else {
          recorder_(entry.record);
        }
      }
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    recorded_ = next;
    error_ = error;
    room_.notify_one();
  }
}

}  // namespace train_results
