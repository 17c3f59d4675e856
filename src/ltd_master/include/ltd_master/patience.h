#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <stdexcept>

namespace ltd_master {

/// A wait was ended on request (Ctrl-C, stop) before its condition was met.
class WaitInterrupted : public std::runtime_error {
 public:
  WaitInterrupted() : std::runtime_error("interrupted while waiting for other nodes") {}
};

/// A wait for other nodes: its stages of 1, 3 and 10 s, each worth a warning, its deadline and its interruption.
class Patience {
 public:
  /// Longest wait between two checks of the time [s].
  static constexpr double kCheckPeriod = 0.1;
  static constexpr std::array<double, 3> kStages = {1.0, 3.0, 10.0};  ///< [s]

  /// @param deadline_s   [wall time] 0: none
  /// @param interrupted  true ends the wait; must outlive this
  Patience(double deadline_s, const std::function<bool()>& interrupted)
      : deadline_s_(deadline_s), interrupted_(interrupted) {}

  /// Checks the time, and calls warn(seconds) when a new stage is reached.
  /// @return whether the deadline is still ahead
  /// @throws WaitInterrupted
  template <class Warn>
  bool Look(const Warn& warn) {
    if (interrupted_()) throw WaitInterrupted();
    const double waited_s = std::chrono::duration<double>(Clock::now() - start_).count();
    if (deadline_s_ > 0.0 && waited_s > deadline_s_) return false;
    if (stage_ == kStages.size() || waited_s < kStages[stage_]) return true;
    warn(kStages[stage_]);
    ++stage_;
    return true;
  }
  bool has_warned() const { return stage_ > 0; }
  double deadline_s() const { return deadline_s_; }

 private:
  using Clock = std::chrono::steady_clock;

  double deadline_s_;
  const std::function<bool()>& interrupted_;
  Clock::time_point start_ = Clock::now();
  std::size_t stage_ = 0;
};

}  // namespace ltd_master
