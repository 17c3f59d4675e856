#pragma once

#include <fcntl.h>
#include <linux/futex.h>
#include <ros/serialization.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <chrono>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <string>

#include "train_brake_msgs/bounded_stream.h"

/// Memory that a train's master shares with those wagon nodes that run on the same machine: the service Step
/// without sockets.
///
///   memory    a head, then slots. A slot belongs permanently to one process, and holds its request and its
///             reply, serialised as they are on the wire.
///   call c    master  writes the requests, numbers them c, and wakes all ranks at once
///             rank    finds its request numbered c, moves its vehicles, writes its reply, numbers it c, and
///                     takes one off `unreplied`; the rank that takes the last one off wakes the master
///             master  reads the replies that are numbered c
///
/// So a call costs each rank one system call, in which it sleeps, and the master two. A process that has been
/// given up and wakes up late can wake the master too early, but its slot is not read any more.
///
/// The memory is a file without a name (memfd_create(2)): it cannot outlive the processes that use it. They
/// open it as /proc/PID/fd/DESCRIPTOR of the master, which needs the permission to read the master's memory anyway. It
/// is sealed against changes of its size.
namespace train_brake_msgs {

constexpr std::size_t kCacheLine = 64;

/// An event count between processes: a thread that reads it before looking for work misses no event, however late its
/// wait begins.
class alignas(kCacheLine) EventCount {
 public:
  std::uint32_t count() const { return count_.load(); }

  /// Counts one more event and wakes all who wait.
  void Notify() {
    count_.fetch_add(1);
    if (waiters_.load() > 0) syscall(SYS_futex, &count_, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
  }

  /// Sleeps until there has been an event since the count was read; a signal may end the sleep, too.
  /// @param seen  the count as it was read
  void Wait(std::uint32_t seen, double timeout_s) {
    const auto seconds = static_cast<std::time_t>(timeout_s);
    const timespec timeout{seconds, static_cast<long>(1e9 * (timeout_s - static_cast<double>(seconds)))};
    waiters_.fetch_add(1);
    if (count_.load() == seen) syscall(SYS_futex, &count_, FUTEX_WAIT, seen, &timeout, nullptr, 0);
    waiters_.fetch_sub(1);
  }

 private:
  std::atomic<std::uint32_t> count_;
  std::atomic<std::uint32_t> waiters_;  ///< too many if some died in their sleep, which costs a needless call
};

/// Spins for a short while before a sleep. That saves the time of a wake-up, but may keep the core from another thread,
/// which shows only afterwards: after each spin in vain, twice as many waits (16 to 4096) do not spin.
class AdaptiveSpin {
 public:
  /// @return whether there has been an event since the count was read
  bool Spin(const EventCount& event, std::uint32_t seen) {
    if (left_out_ > 0) {
      --left_out_;
      return event.count() != seen;
    }
    const Clock::time_point end = Clock::now() + kLength;
    do {
      if (event.count() != seen) {
        to_leave_out_ = kFewest;
        return true;
      }
    } while (Clock::now() < end);
    left_out_ = to_leave_out_;
    to_leave_out_ = std::min(2 * to_leave_out_, kMost);
    return false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds kLength{200};
  static constexpr int kFewest = 16, kMost = 4096;

  int left_out_ = 0;
  int to_leave_out_ = kFewest;
};

/// Yields the core up to this many times, until there is an event since the count was read. With many ranks on a core
/// that is faster than a sleep and a wake-up if the others are ranks, too; with other work on the core, a yield may
/// take as long as that work.
/// @return whether there has been an event
inline bool YieldUntil(const EventCount& event, std::uint32_t seen, std::uint32_t yields) {
  constexpr std::uint32_t kMost = 64;  // so that a long wait soon becomes a sleep
  for (std::uint32_t i = 0; i < std::min(yields, kMost) && event.count() == seen; ++i) sched_yield();
  return event.count() != seen;
}

/// A message from one process to another, with the number of the call that it belongs to. Its bytes follow it.
class MessageBuffer {
 public:
  static constexpr std::size_t Size(std::size_t room) { return sizeof(MessageBuffer) + room; }

  /// The call whose message it holds; 0: none yet.
  std::uint64_t call() const { return call_.load(std::memory_order_acquire); }

  /// @param room  bytes that follow it
  /// @return whether the message fits; if not, the buffer records that instead
  template <class Message>
  bool Write(std::uint64_t call, const Message& message, std::uint32_t room) {
    const std::uint32_t size = ros::serialization::serializationLength(message);
    const bool fits = size <= room;
    if (fits) {
      ros::serialization::OStream stream(bytes(), size);
      stream.next(message);
    }
    size_ = fits ? size : kTooLarge;
    call_.store(call, std::memory_order_release);
    return fits;
  }

  /// @return whether it holds a message; if not, that did not fit
  /// @throws std::exception if it holds anything else
  template <class Message>
  bool Read(Message& message, std::uint32_t room) {
    const std::uint32_t size = size_;
    if (size == kTooLarge) return false;
    if (size > room) throw std::runtime_error("a message of " + std::to_string(size) + " bytes is too long");
    ReadMessage(bytes(), size, message);
    return true;
  }

 private:
  static constexpr std::uint32_t kTooLarge = std::numeric_limits<std::uint32_t>::max();

  std::uint8_t* bytes() { return reinterpret_cast<std::uint8_t*>(this + 1); }

  std::atomic<std::uint64_t> call_;
  std::uint32_t size_;
};

/// How the memory is laid out. It begins with this.
struct ExchangeLayout {
  static constexpr std::uint64_t kMagic = 0x32706174536e6954;  ///< a different value for every layout

  std::uint64_t magic = kMagic;
  std::uint64_t run_id = 0;
  std::uint32_t slots = 0;
  std::uint32_t request_room = 0;  ///< bytes of the largest message
  std::uint32_t reply_room = 0;

  std::size_t RequestSize() const { return WholeLines(MessageBuffer::Size(request_room)); }
  std::size_t SlotSize() const { return RequestSize() + WholeLines(MessageBuffer::Size(reply_room)); }
  std::size_t SlotOffset(std::uint32_t slot) const;
  std::size_t Size() const { return SlotOffset(slots); }
  bool FitsInto(std::size_t size) const {
    return size >= SlotOffset(0) && slots <= (size - SlotOffset(0)) / SlotSize();
  }

 private:
  static std::size_t WholeLines(std::size_t size) { return (size + kCacheLine - 1) / kCacheLine * kCacheLine; }
};

/// The head, followed by the slots. Initially all zero, except the layout.
struct ExchangeHead {
  ExchangeLayout layout;
  std::atomic<std::uint32_t> threads;      ///< of the ranks that use the memory
  std::atomic<std::uint32_t> master_core;  ///< that the master runs on
  std::atomic<std::uint32_t> yields;       ///< of a rank before it sleeps, where cores are shared
  EventCount requests;
  alignas(kCacheLine) std::atomic<std::int32_t> unreplied;
  std::atomic<std::uint32_t> last_slot;  ///< of the last one to reply
  EventCount replies;
};

inline std::size_t ExchangeLayout::SlotOffset(std::uint32_t slot) const {
  return sizeof(ExchangeHead) + slot * SlotSize();
}

static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free,
              "an atomic that takes a lock is none between processes");

/// The memory as a process sees it.
class ExchangeMemory {
 public:
  /// Maps a descriptor that another process, or this one, has open.
  /// @throws std::exception if this process cannot do that, or if it is not the memory of that run
  ExchangeMemory(std::uint32_t pid, std::uint32_t descriptor, std::uint64_t run_id) {
    namespace ipc = boost::interprocess;
    const std::string path = "/proc/" + std::to_string(pid) + "/fd/" + std::to_string(descriptor);
    const ipc::file_mapping file(path.c_str(), ipc::read_write);
    const int seals = fcntl(file.get_mapping_handle().handle, F_GET_SEALS);
    if (seals < 0 || (seals & F_SEAL_SHRINK) == 0) throw std::runtime_error(path + " is not sealed memory");
    region_ = ipc::mapped_region(file, ipc::read_write);
    if (region_.get_size() >= sizeof(ExchangeHead)) layout_ = head().layout;
    if (layout_.run_id != run_id || layout_.magic != ExchangeLayout::kMagic || !layout_.FitsInto(region_.get_size())) {
      throw std::runtime_error(path + " is not the memory of run " + std::to_string(run_id));
    }
  }

  const ExchangeLayout& layout() const { return layout_; }
  ExchangeHead& head() const { return *static_cast<ExchangeHead*>(region_.get_address()); }
  MessageBuffer& request(std::uint32_t slot) const { return BufferAt(layout_.SlotOffset(slot)); }
  MessageBuffer& reply(std::uint32_t slot) const { return BufferAt(layout_.SlotOffset(slot) + layout_.RequestSize()); }

 private:
  MessageBuffer& BufferAt(std::size_t offset) const {
    return *reinterpret_cast<MessageBuffer*>(static_cast<std::uint8_t*>(region_.get_address()) + offset);
  }

  boost::interprocess::mapped_region region_;
  ExchangeLayout layout_;  ///< as it was checked
};

}  // namespace train_brake_msgs
