#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ltd_master/late_watch.h"
#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/ranks.h"

namespace ltd_master {

class RankCaller;
class RankMessages;

struct RosTransportOptions {
  double start_timeout_s = 60.0;      ///< for all ranks to come up, and to be configured; 0: for ever
  double exchange_deadline_s = 30.0;  ///< for all replies of an exchange; 0: for ever
  int blocking_threads = 0;           ///< 0: asynchronous; else see MakeBlockingCaller
  std::function<bool()> interrupted = [] { return false; };  ///< asked ten times a second while waiting
};

/// How the last exchange went, in wall time.
struct ExchangeTiming {
  double wall_s = 0.0;    ///< from the packing of the first request to the unpacking of the last reply
  int last_rank = 0;      ///< index of the rank that replied last
  bool was_late = false;  ///< it took so long that those who were late have been named
};

/// Ranks that are wagon_node processes: the master's end of Configure.srv and Step.srv.
///
/// Start     waits until every rank has advertised its services (names who is missing, every 5 s), then
///           configures all of them side by side.
/// Exchange  sends every rank its request before it waits for any, and returns when all have replied.
///
/// Whoever is late in either is named after 1, 3 and 10 s; at the deadline the wait ends. Both throw
/// RankFailure and WaitInterrupted; afterwards the transport is of no more use.
///
/// The connections last as long as the transport. Their end tells the wagon nodes that the run is over.
class RosTransport : public train_dynamics::Transport {
 public:
  /// @param ranks          their names are resolved in this node's namespace
  /// @param run_id         unlike that of any other run; not 0
  /// @param scenario_text  config::Write(scenario)
  RosTransport(std::vector<train_dynamics::Rank> ranks, std::uint64_t run_id,
               const std::string& scenario_text, RosTransportOptions options);
  ~RosTransport() override;

  void Start(train_dynamics::ExchangeReply& reply) override;
  void Exchange(const train_dynamics::ExchangeRequest& request,
                train_dynamics::ExchangeReply& reply) override;

  const ExchangeTiming& timing() const { return timing_; }
  const std::vector<train_dynamics::Rank>& ranks() const { return ranks_; }  ///< with resolved names

 private:
  void WaitForRanks();

  std::vector<train_dynamics::Rank> ranks_;
  RosTransportOptions options_;
  std::unique_ptr<RankMessages> messages_;
  std::unique_ptr<RankCaller> caller_;
  ExchangeTiming timing_;
};

}  // namespace ltd_master
