#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "ltd_master/late_watch.h"

namespace ltd_master {

/// Calls the same service of all ranks side by side.
class RankCaller {
 public:
  virtual ~RankCaller() = default;

  /// Tries to connect to a rank's services.
  /// @return why it cannot be reached yet; empty: it is connected
  /// @throws RankFailure if it can be reached, but speaks otherwise
  virtual std::string Connect(int rank) = 0;

  /// Sends calls[rank].request to every rank and fills calls[rank].response.
  /// @return the rank that replied last
  /// @throws WaitInterrupted, RankFailure
  virtual int Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) = 0;
  virtual int Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) = 0;
};

/// One thread, which speaks TCPROS with all ranks: requests go out before any reply is waited for.
std::unique_ptr<RankCaller> MakeAsynchronousCaller(const std::vector<train_dynamics::Rank>& ranks);

/// A pool of threads, each of which calls one rank after the other through roscpp's ServiceClient.
///
/// For comparison, and in case a network needs what roscpp does beyond plain TCPROS.
std::unique_ptr<RankCaller> MakeBlockingCaller(const std::vector<train_dynamics::Rank>& ranks, int threads);

}  // namespace ltd_master
