#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ltd_master/patience.h"
#include "train_dynamics/train/ranks.h"

namespace ltd_master {

/// A rank that did not come up, died, was late, refused a request or replied nonsense. The run cannot go on.
///
/// what() names the rank, its vehicles and the exchange.
class RankFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// @param when  "exchange 17"
  RankFailure(const train_dynamics::Rank& rank, const std::string& when, const std::string& what);
};

/// The connection to a rank broke, or it is late beyond the deadline: another process may take its place.
class RankLost : public RankFailure {
 public:
  using RankFailure::RankFailure;
};

/// A rank that is given up: its connection broke, it replied what cannot be read, or it is late beyond the
/// deadline.
struct LostRank {
  int rank;         ///< index
  std::string why;  ///< "closed the connection"
};

/// The chosen ranks with their vehicles, the first few of them: "/train/wagon_007 (vehicles 7-12), ...".
std::string NamesOf(const std::vector<train_dynamics::Rank>& ranks, const std::vector<bool>& chosen);

/// Patience with ranks: warns when a wait takes 1, 3 and 10 s, naming those who are late, and knows the
/// deadline.
class LateWatch {
 public:
  /// @param when         what is waited for, "exchange 17"
  /// @param deadline_s   [wall time] 0: none
  /// @param interrupted  true ends the wait
  LateWatch(const std::vector<train_dynamics::Rank>& ranks, std::string when, double deadline_s,
            const std::function<bool()>& interrupted);

  /// For how long to wait before the time is checked [s].
  static constexpr double kCheckPeriod = Patience::kCheckPeriod;

  /// Looks at the watch.
  /// @param pending  [rank] whether it is still waited for
  /// @return whether it is in time; false: the deadline has passed, and those ranks are lost for NoReply()
  /// @throws WaitInterrupted
  bool Look(const std::vector<bool>& pending);

  /// Ranks are lost for good: gives an interruption, which may have hit them first, a second to come in.
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
