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
///   memory    a head, then slots. A slot belongs to one process for good, and holds its request and its
///             reply, serialised as they are on the wire.
///   call c    master  writes the requests, numbers them c, and rings once for all ranks
///             rank    finds its request numbered c, moves its vehicles, writes its reply, numbers it c, and
///                     takes one off `unreplied`; whoever takes the last one off rings for the master
///             master  reads the replies that are numbered c
///
/// So a call costs each rank one system call, in which it sleeps, and the master two. A process that has been
/// given up and wakes up late can ring too early, but nobody reads its slot any more.
///
/// The memory is a file without a name (memfd_create(2)): it cannot outlive the processes that use it. They
/// open it as /proc/PID/fd/DESCRIPTOR of the master, which only who may look into the master anyway can. It is
/// sealed against changes of its size.
namespace train_brake_msgs {

constexpr std::size_t kCacheLine = 64;

/// A bell between processes. Nobody misses a ring who has counted the rings before he looked for work.
class alignas(kCacheLine) Bell {
 public:
  std::uint32_t rings() const { return rings_.load(); }

  /// Wakes all who wait.
  void Ring() {
    rings_.fetch_add(1);
    if (sleepers_.load() > 0) syscall(SYS_futex, &rings_, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
  }

  /// Sleeps until it has rung since its rings were counted; a signal may end the sleep, too.
  /// @param heard  that count
  void Wait(std::uint32_t heard, double timeout_s) {
    const auto seconds = static_cast<std::time_t>(timeout_s);
    const timespec timeout{seconds, static_cast<long>(1e9 * (timeout_s - static_cast<double>(seconds)))};
    sleepers_.fetch_add(1);
    if (rings_.load() == heard) syscall(SYS_futex, &rings_, FUTEX_WAIT, heard, &timeout, nullptr, 0);
    sleepers_.fetch_sub(1);
  }

 private:
  std::atomic<std::uint32_t> rings_;
  std::atomic<std::uint32_t> sleepers_;  ///< too many if some died in their sleep: a needless call, no more
};

/// Stays awake for a short while before a sleep. That saves the time it takes to wake up, but keeps the core from
/// whoever needs it, which shows only afterwards: after each vigil in vain, twice as many are left out.
class Vigil {
 public:
  /// @return whether the bell has rung since its rings were counted
  bool Hears(const Bell& bell, std::uint32_t heard) {
    if (left_out_ > 0) {
      --left_out_;
      return bell.rings() != heard;
    }
    const Clock::time_point end = Clock::now() + kLength;
    do {
      if (bell.rings() != heard) {
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

/// Leaves the core to others up to so many times, as long as the bell has not rung since its rings were counted. With many
/// ranks on a core that takes less time than to sleep and be woken, as long as the others are ranks, too; beside other work
/// each turn may take as long as that wants.
/// @return whether it has rung
inline bool HearsInTurns(const Bell& bell, std::uint32_t heard, std::uint32_t turns) {
  constexpr std::uint32_t kMost = 64;  // so that whoever waits for long sleeps soon
  for (std::uint32_t turn = 0; turn < std::min(turns, kMost) && bell.rings() == heard; ++turn) sched_yield();
  return bell.rings() != heard;
}

/// A message from one process to another, with the number of the call that it belongs to. Its bytes follow it.
class Letter {
 public:
  static constexpr std::size_t Size(std::size_t room) { return sizeof(Letter) + room; }

  /// The call whose message it holds; 0: none yet.
  std::uint64_t call() const { return call_.load(std::memory_order_acquire); }

  /// @param room  bytes that follow it
  /// @return whether the message fits; if not, the letter says that instead
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
  static constexpr std::uint64_t kMagic = 0x32706174536e6954;  ///< another one for every other layout

  std::uint64_t magic = kMagic;
  std::uint64_t run_id = 0;
  std::uint32_t slots = 0;
  std::uint32_t request_room = 0;  ///< bytes of the largest message
  std::uint32_t reply_room = 0;

  std::size_t RequestSize() const { return WholeLines(Letter::Size(request_room)); }
  std::size_t SlotSize() const { return RequestSize() + WholeLines(Letter::Size(reply_room)); }
  std::size_t SlotOffset(std::uint32_t slot) const;
  std::size_t Size() const { return SlotOffset(slots); }
  bool FitsInto(std::size_t size) const {
    return size >= SlotOffset(0) && slots <= (size - SlotOffset(0)) / SlotSize();
  }

 private:
  static std::size_t WholeLines(std::size_t size) {
    return (size + kCacheLine - 1) / kCacheLine * kCacheLine;
  }
};

/// What the slots follow. All zero in the beginning, but the layout.
struct ExchangeHead {
  ExchangeLayout layout;
  std::atomic<std::uint32_t> threads;      ///< of the ranks that use the memory
  std::atomic<std::uint32_t> master_core;  ///< that the master runs on
  std::atomic<std::uint32_t>
      turns;  ///< that a rank leaves to others before it sleeps, where cores are shared
  Bell requests;
  alignas(kCacheLine) std::atomic<std::int32_t> unreplied;
  std::atomic<std::uint32_t> last_slot;  ///< of the last one to reply
  Bell replies;
};

inline std::size_t ExchangeLayout::SlotOffset(std::uint32_t slot) const {
  return sizeof(ExchangeHead) + slot * SlotSize();
}

static_assert(std::atomic<std::uint64_t>::is_always_lock_free &&
                  std::atomic<std::uint32_t>::is_always_lock_free,
              "an atomic that takes a lock is none between processes");

/// The memory as a process sees it.
class ExchangeMemory {
 public:
  /// Maps what a process has open: another one, or this.
  /// @throws std::exception if this process cannot do that, or if it is not the memory of that run
  ExchangeMemory(std::uint32_t pid, std::uint32_t descriptor, std::uint64_t run_id) {
    namespace ipc = boost::interprocess;
    const std::string path = "/proc/" + std::to_string(pid) + "/fd/" + std::to_string(descriptor);
    const ipc::file_mapping file(path.c_str(), ipc::read_write);
    const int seals = fcntl(file.get_mapping_handle().handle, F_GET_SEALS);
    if (seals < 0 || (seals & F_SEAL_SHRINK) == 0) throw std::runtime_error(path + " is not sealed memory");
    region_ = ipc::mapped_region(file, ipc::read_write);
    if (region_.get_size() >= sizeof(ExchangeHead)) layout_ = head().layout;
    if (layout_.run_id != run_id || layout_.magic != ExchangeLayout::kMagic ||
        !layout_.FitsInto(region_.get_size())) {
      throw std::runtime_error(path + " is not the memory of run " + std::to_string(run_id));
    }
  }

  const ExchangeLayout& layout() const { return layout_; }
  ExchangeHead& head() const { return *static_cast<ExchangeHead*>(region_.get_address()); }
  Letter& request(std::uint32_t slot) const { return LetterAt(layout_.SlotOffset(slot)); }
  Letter& reply(std::uint32_t slot) const {
    return LetterAt(layout_.SlotOffset(slot) + layout_.RequestSize());
  }

 private:
  Letter& LetterAt(std::size_t offset) const {
    return *reinterpret_cast<Letter*>(static_cast<std::uint8_t*>(region_.get_address()) + offset);
  }

  boost::interprocess::mapped_region region_;
  ExchangeLayout layout_;  ///< as it was checked
};

}  // namespace train_brake_msgs
