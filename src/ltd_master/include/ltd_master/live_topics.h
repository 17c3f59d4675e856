#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <train_brake_msgs/RunStatus.h>

#include <chrono>
#include <map>
#include <optional>

#include "train_results/conversions.h"

namespace ltd_master {

/// The newest record for people to look at, at most 20 times per second of WALL time however fast the run is:
///
///   live/status              RunStatus: a few numbers, for plotting tools and panels
///   live/state  live/in_train_forces  live/brake_pressures  live/wagon_NNN/state
///                            the same messages as without `live/`, where every record comes
///
/// All are latched: a late subscriber, or one during a pause, gets the newest message.
class LiveTopics {
 public:
  /// The state of the run's loop, which is not part of the record.
  struct Pace {
    std::uint8_t state;  ///< of RunStatus
    double real_time_factor, wanted_real_time_factor;
  };

  explicit LiveTopics(const ros::NodeHandle& node);

  /// An observer of the run's TrainMaster: publishes the record, or keeps it until Settle() or the next one.
  void Show(const train_dynamics::TrainRecord& record, const Pace& pace);

  /// Publishes what was held back, and the pace if it has changed: for a run that is paused or has ended.
  void Settle(const Pace& pace);

  /// The newest record, whether it was published or not; null before the first. Refers to memory of this object.
  std::optional<train_dynamics::TrainRecord> last() const;

 private:
  using Clock = std::chrono::steady_clock;

  void Publish(const Pace& pace);
  void PublishRecord(const train_dynamics::TrainRecord& record);

  ros::NodeHandle node_;
  ros::Publisher status_publisher_, state_publisher_, forces_publisher_, pressures_publisher_;
  std::map<int, ros::Publisher> wagon_publishers_;  ///< by index
  train_brake_msgs::RunStatus status_;
  train_brake_msgs::TrainState state_;
  train_brake_msgs::InTrainForces forces_;
  train_brake_msgs::BrakePressures pressures_;
  train_brake_msgs::WagonState wagon_;
  train_dynamics::TrainRecord last_;
  bool has_record_ = false;
  bool held_back_ = false;
  Clock::time_point next_;
};

}  // namespace ltd_master
