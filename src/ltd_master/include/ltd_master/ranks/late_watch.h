#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ltd_master/patience.h"
#include "train_dynamics/train/ranks.h"

namespace ltd_master {

/// A rank did not start, died, was late, refused a request or sent an invalid reply. The run cannot continue.
///
/// what() names the rank, its vehicles and the exchange.
class RankFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// @param when  "exchange 17"
  RankFailure(const train_dynamics::Rank& rank, const std::string& when, const std::string& what);
};

/// The connection to a rank broke, or the deadline has passed: another process may take its place.
class RankLost : public RankFailure {
 public:
  using RankFailure::RankFailure;
};

/// A rank that is given up: its connection broke, its reply cannot be read, or the deadline has passed.
struct LostRank {
  int rank;         ///< index
  std::string why;  ///< "closed the connection"
};

/// The chosen ranks with their vehicles, the first few of them: "/train/wagon_007 (vehicles 7-12), ...".
std::string NamesOf(const std::vector<train_dynamics::Rank>& ranks, const std::vector<bool>& chosen);

/// Patience with ranks: warns when a wait takes 1, 3 and 10 s, with the names of the late ranks, and keeps the
/// deadline.
class LateWatch {
 public:
  /// @param when         what is waited for, "exchange 17"
  /// @param deadline_s   [wall time] 0: none
  /// @param interrupted  true ends the wait
  LateWatch(const std::vector<train_dynamics::Rank>& ranks, std::string when, double deadline_s,
            const std::function<bool()>& interrupted);

  /// Longest wait between two checks of the time [s].
  static constexpr double kCheckPeriod = Patience::kCheckPeriod;

  /// Looks at the watch.
  /// @param pending  [rank] whether its reply is pending
  /// @return true before the deadline; false: it has passed, and those ranks are lost, because of NoReply()
  /// @throws WaitInterrupted
  bool Look(const std::vector<bool>& pending);

  /// Ends the run because ranks are lost. Waits a second first: an interruption may have ended them, and arrive here
  /// later.
  /// @throws WaitInterrupted, RankFailure
  [[noreturn]] void GiveUp(const std::vector<LostRank>& lost) const;

  std::string NoReply() const;  ///< "no reply within 30 s"
  const std::string& when() const { return when_; }
  bool was_late() const { return patience_.has_warned(); }  ///< whether it has warned

 private:
  const std::vector<train_dynamics::Rank>& ranks_;
  const std::string when_;
  const std::function<bool()>& interrupted_;
  Patience patience_;
};

}  // namespace ltd_master
