#pragma once

#include <train_brake_msgs/Step.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ltd_master/ranks/late_watch.h"
#include "ltd_master/ranks/recovery_log.h"
#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/scenario.h"

namespace ltd_master {

class RankCaller;
class RankMessages;

struct RosTransportOptions {
  double start_timeout_s = 60.0;            ///< for all ranks to start and to be configured; 0: no limit
  double exchange_deadline_s = 30.0;        ///< for all replies of an exchange; 0: no limit
  bool recover = true;                      ///< bring lost ranks back; false: the run ends with them
  double recovery_timeout_s = 60.0;         ///< for each lost rank, one after the other; 0: no limit
  std::uint64_t snapshot_exchanges = 1000;  ///< from one snapshot of the vehicles to the next
  bool shared_memory = true;                ///< with ranks on the same machine; only asynchronous
  std::function<bool()> interrupted = [] { return false; };  ///< polled ten times a second while waiting
};

/// How the last exchange went, in wall time.
struct ExchangeTiming {
  double wall_s = 0.0;    ///< from the packing of the first request to the unpacking of the last reply
  int last_rank = 0;      ///< index of the rank that replied last
  bool was_late = false;  ///< a warning named the late ranks
};

/// Ranks that are wagon_node processes: the master's end of Configure.srv and Step.srv.
///
/// Start     waits until every rank has advertised its services (names the missing ones every 5 s), then
///           configures all of them side by side.
/// Exchange  sends every rank its request before it waits for any, and returns when all have replied.
///
/// A rank that is late in either is named after 1, 3 and 10 s, and counts as lost at the deadline, or when its
/// connection breaks or its reply cannot be read. A lost rank is restored while the others wait:
///
///   1. wait until a node of its name answers: respawned, started by hand anywhere, or the same one running again
///   2. Configure it with the last snapshot of its vehicles
///   3. Step it again through the exchanges since: the same bits, because a rank's motion depends on nothing else
///
/// A node that refuses one of these, or is lost in it, is rejected; the next one is waited for.
///
/// A rank that gives no snapshots cannot be restored: its loss ends the run.
///
/// Both throw RankFailure (no recovery wanted, or recovery failed; a refusal; a reply that makes no sense) and
/// WaitInterrupted; afterwards the transport cannot be used.
///
/// The connections last as long as the transport. Wagon nodes take their end as the end of the run.
class RosTransport : public train_dynamics::Transport {
 public:
  /// @param ranks   their names are resolved in this node's namespace
  /// @param run_id  unique to this run; not 0
  RosTransport(std::vector<train_dynamics::Rank> ranks, std::uint64_t run_id,
               const train_dynamics::ScenarioParams& scenario, RosTransportOptions options);
  ~RosTransport() override;

  void Start(train_dynamics::ExchangeReply& reply) override;
  void Resume(std::uint64_t exchange, const std::vector<train_dynamics::StateRow>& snapshot,
              train_dynamics::ExchangeReply& reply) override;
  void Exchange(const train_dynamics::ExchangeRequest& request, train_dynamics::ExchangeReply& reply) override;

  bool GivesSnapshots() const override;

  const ExchangeTiming& timing() const { return timing_; }
  unsigned recoveries() const { return recoveries_; }                        ///< of lost ranks, so far
  const std::vector<train_dynamics::Rank>& ranks() const { return ranks_; }  ///< with resolved names

 private:
  using Clock = std::chrono::steady_clock;

  void WaitForRanks();
  /// Restores the ranks that were lost in a call. @param catch_up what a replacement node has to do
  void Recover(const std::vector<LostRank>& lost, const LateWatch& watch,
               const std::function<void(int rank)>& catch_up);
  /// Tries nodes of a lost rank's name until one of them has caught up.
  void BringBack(const LostRank& lost, const std::string& when, const std::function<void()>& catch_up);
  void Reconfigure(int rank);
  void Replay(int rank);
  void StepOne(int rank, train_brake_msgs::Step& call);
  void KeepForRecovery();

  std::vector<train_dynamics::Rank> ranks_;
  RosTransportOptions options_;
  std::unique_ptr<RankMessages> messages_;
  RecoveryLog log_;
  train_dynamics::ExchangeRequest request_;  ///< of the present exchange
  unsigned recoveries_ = 0;
  std::unique_ptr<RankCaller> caller_;
  ExchangeTiming timing_;
};

}  // namespace ltd_master
