#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

namespace ltd_master {

/// The train's time for other nodes.
///
///   clock    always, in the train's namespace: /train/clock, /north/train/clock
///   /clock   from one train per ROS master, whose nodes share one /clock: from the train in the namespace /train, or
///            as the parameter ~global_clock sets
///
/// Beside each clock, the parameter `use_sim_time` makes nodes follow it: true while the run lasts, then restored, so
/// that nodes started later do not wait for a stopped clock.
///
/// Both topics are latched: a subscriber that arrives in a pause gets the present time. ROS takes time 0 for "no time
/// yet", so the clock begins at 1 ns.
class SimulatedClock {
 public:
  /// @throws std::invalid_argument if another node that is alive publishes /clock already
  SimulatedClock(ros::NodeHandle& train, bool is_global);
  SimulatedClock(const SimulatedClock&) = delete;
  SimulatedClock& operator=(const SimulatedClock&) = delete;
  ~SimulatedClock();

  /// At a record: publishes multiples of 10 ms, i.e. 100 Hz of simulated time, whatever the record interval.
  void Show(double simulated_s);
  /// During a pause: publishes this time, unless it was published last.
  void Settle(double simulated_s);
  /// Sets use_sim_time, once more after a restart of the ROS master.
  void TellUse() const;

  /// Whether a train in this namespace owns /clock by default.
  static bool OwnsGlobalClock(const std::string& train_namespace) { return train_namespace == "/train"; }

 private:
  void Publish(double simulated_s);

  struct Topic {
    std::string use_parameter;
    ros::Publisher publisher;
    bool was_used = false;  ///< what the parameter was before
  };
  Topic own_, global_;
  bool is_global_;
  double last_s_ = -1.0;
};

}  // namespace ltd_master
