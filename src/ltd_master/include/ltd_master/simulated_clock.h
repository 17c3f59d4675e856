#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

namespace ltd_master {

/// The train's time for other nodes.
///
///   clock    always, in the train's namespace: /train/clock, /north/train/clock
///   /clock   from one train per ROS master, whose nodes all have one /clock: from that in the namespace /train, or as
///            the parameter ~global_clock says
///
/// Beside each clock stands the parameter `use_sim_time`, which tells nodes to follow it: true as long as the run
/// lasts; afterwards it is again what it was, so that nodes that come later do not wait for a clock that has stopped.
///
/// Both topics are latched: who comes in a pause gets the time at which the train stands. ROS takes time 0 for "no time
/// yet", so the clock begins at 1 ns.
class SimulatedClock {
 public:
  /// @throws std::invalid_argument if another node that is alive publishes /clock already
  SimulatedClock(ros::NodeHandle& train, bool is_global);
  SimulatedClock(const SimulatedClock&) = delete;
  SimulatedClock& operator=(const SimulatedClock&) = delete;
  ~SimulatedClock();

  /// At a record: publishes multiples of 10 ms, 100 Hz of simulated time however often records are made.
  void Show(double simulated_s);
  /// While the train stands: publishes this time, unless it is the last one.
  void Settle(double simulated_s);
  /// Sets use_sim_time, once more after a restart of the ROS master.
  void TellUse() const;

  /// Whether a train in this namespace owns /clock unless told otherwise.
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
