#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ltd_master/ranks/late_watch.h"

namespace ltd_master {

/// The outcome of a call of all ranks.
struct CallOutcome {
  int last_rank = 0;           ///< index of the rank that replied last
  std::vector<LostRank> lost;  ///< ranks without a valid response; they are disconnected
};

/// Calls the same service of all ranks side by side.
///
/// A lost rank is disconnected permanently, and later data from it is discarded. Connect() then finds the process that
/// has taken its name since.
class RankCaller {
 public:
  virtual ~RankCaller() = default;

  /// Tries to connect to a rank's services, unless it is connected.
  /// @return why it cannot be reached yet; empty: it is connected
  /// @throws RankFailure if it can be reached, but has another protocol
  virtual std::string Connect(int rank) = 0;
  virtual void Disconnect(int rank) = 0;

  /// Sends calls[rank].request to every rank, fills calls[rank].response, and returns when every rank has
  /// replied or is lost.
  /// @throws WaitInterrupted
  virtual CallOutcome Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) = 0;
  virtual CallOutcome Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) = 0;

  /// Calls one rank alone.
  /// @throws WaitInterrupted, RankLost; then the rank is disconnected
  virtual void CallOne(int rank, train_brake_msgs::Configure& call, LateWatch& watch) = 0;
  virtual void CallOne(int rank, train_brake_msgs::Step& call, LateWatch& watch) = 0;
};

/// Why a rank cannot be looked up: "has not advertised", or the ROS master is not there.
std::string WhyNotFound();

/// One thread that handles TCPROS with all ranks: all requests are sent before it waits for a reply. Calls of Step to
/// ranks on this machine go through memory that they share with this process, if they can.
/// @param run_id  of the run that the memory is for; 0: share none
std::unique_ptr<RankCaller> MakeAsynchronousCaller(const std::vector<train_dynamics::Rank>& ranks,
                                                   std::uint64_t run_id);

}  // namespace ltd_master
