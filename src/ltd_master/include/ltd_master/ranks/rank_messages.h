#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <cstdint>
#include <string>
#include <vector>

#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/scenario.h"

namespace ltd_master {

/// The time of a failure, as messages name it.
inline constexpr const char* kConfiguration = "configuration";
std::string ExchangeText(std::uint64_t exchange);

/// The requests to and the replies from all ranks, and the conversion of the whole train's arrays to and from them.
/// Replies are checked: RankFailure is thrown for one that does not fit.
class RankMessages {
 public:
  RankMessages(const std::vector<train_dynamics::Rank>& ranks, std::uint64_t run_id,
               const train_dynamics::ScenarioParams& scenario);

  std::vector<train_brake_msgs::Configure> configure;  ///< [rank]
  std::vector<train_brake_msgs::Step> step;            ///< [rank]

  /// Sets the state at which `configure` begins. @param snapshot  [vehicle]; empty: time 0
  /// @throws SnapshotError if it does not have one entry per vehicle
  void BeginAt(std::uint64_t exchange, const std::vector<train_dynamics::StateRow>& snapshot);
  void Unpack(train_dynamics::ExchangeReply& reply);  ///< the replies of `configure`
  /// Whether a rank answers with snapshots; known once its reply to `configure` has been unpacked.
  bool GivesSnapshots(int rank) const { return gives_snapshots_[rank]; }

  void Pack(const train_dynamics::ExchangeRequest& request);
  /// One rank's part of a request.
  void Pack(const train_dynamics::ExchangeRequest& request, int rank, train_brake_msgs::StepRequest& part) const;
  void Unpack(const train_dynamics::ExchangeRequest& request, train_dynamics::ExchangeReply& reply) const;

 private:
  std::vector<train_dynamics::Rank> ranks_;
  std::vector<train_dynamics::VehicleModel> models_;  ///< [vehicle]
  std::vector<double> start_m_;                       ///< [vehicle] centre along the track
  std::vector<bool> gives_snapshots_;                 ///< [rank]
};

}  // namespace ltd_master
