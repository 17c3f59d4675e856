#pragma once

#include <ros/ros.h>
#include <std_msgs/String.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <train_brake_msgs/BrakePressures.h>
#include <train_brake_msgs/InTrainForces.h>
#include <train_brake_msgs/SelectView.h>
#include <train_brake_msgs/TrainState.h>
#include <train_brake_msgs/WagonState.h>

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "train_brake_rviz/board/board.h"
#include "train_brake_rviz/markers.h"
#include "train_node/node_parameters.h"

namespace train_brake_rviz {

/// Shows a train in rviz: listens to its topics, live or from a bag, and publishes the board as markers.
///
///   subscribes  scenario, [live/]state, in_train_forces, brake_pressures, wagon_NNN/state
///   publishes   ~markers (visualization_msgs/MarkerArray), at most 20 per second of wall time
///               ~selection (ViewSelection, latched)
///               tf: track -> wagon_NNN of locomotives and the followed wagon, in metres; board -> track
///               (of a train that is not in the namespace /train these frames carry it: north/train/track)
///   services    ~select (SelectView)
///   parameters  ~live                   default true: listen under live/; false: to every record, as in a bag
///               ~scenario               file, for bags in which the topic is missing
///               ~quantity, ~vehicle     first selection; default coupler_force, and a wagon in full detail
///               ~vertical_exaggeration  of grades and dips under the train; default 0 = what fits
///               ~motion_exaggeration    of the followed wagon's bodies; default 10
class ViewNode {
 public:
  /// @throws std::exception if a parameter is wrong
  ViewNode(const ros::NodeHandle& train, const ros::NodeHandle& own, train_node::NodeParameters& parameters);

 private:
  using Clock = std::chrono::steady_clock;

  void OnScenario(const std_msgs::String& message);
  void OnState(const train_brake_msgs::TrainStateConstPtr& message);
  bool OnSelect(train_brake_msgs::SelectView::Request& request, train_brake_msgs::SelectView::Response& response);

  void Begin(const train_dynamics::ScenarioParams& scenario);
  void PublishSelection();
  void Draw();
  Snapshot MakeSnapshot();
  double RealTimeFactor(double simulated_s);
  void PublishTransforms(const Snapshot& snapshot);

  ros::NodeHandle train_, own_;
  std::string frame_prefix_;  ///< of the train's tf frames
  std::string source_;        ///< prefix of the topics: "live/" or ""
  BoardOptions options_;
  MarkerWriter writer_{"board"};
  Selection selection_;
  int first_vehicle_ = 0;  ///< that the user wants to follow at first; 0 = any

  train_dynamics::ScenarioParams scenario_;
  std::unique_ptr<Board> board_;  ///< null: no scenario yet
  std::unique_ptr<Elevation> elevation_;

  train_brake_msgs::TrainStateConstPtr state_;
  train_brake_msgs::InTrainForcesConstPtr forces_;
  train_brake_msgs::BrakePressuresConstPtr pressures_;
  std::map<int, train_brake_msgs::WagonStateConstPtr> wagons_;  ///< by index

  struct Moment {
    Clock::time_point wall;
    double simulated_s;
  };
  std::deque<Moment> last_second_;
  Clock::time_point next_refresh_;
  unsigned viewers_ = 0;

  std::vector<ros::Subscriber> subscribers_, wagon_subscribers_;
  ros::Publisher markers_publisher_, selection_publisher_;
  ros::ServiceServer select_service_;
  tf2_ros::TransformBroadcaster transforms_;
  std::map<int, ros::Time> transform_sent_;  ///< [index] stamp of the last one
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  ros::WallTimer timer_;
};

}  // namespace train_brake_rviz
