#pragma once

#include <ros/subscriber.h>
#include <ros/this_node.h>
#include <rviz/panel.h>
#include <train_brake_msgs/RunStatus.h>
#include <train_brake_msgs/ViewSelection.h>

#include <functional>

#include "train_brake_rviz/run_client.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace train_brake_rviz {

/// The controls of a train in rviz, in one row like those of a player: play, pause, step, pace; what colours
/// the vehicles and which one is followed. The train is the one in the namespace of rviz's node, as launched with
/// it; for an rviz in no namespace, /train.
///
/// The buttons show the train's reported state (live/status, view/selection), not what was pressed last. Messages must
/// arrive in the window's thread, as they do in rviz.
class RunPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit RunPanel(QWidget* parent = nullptr);

 Q_SIGNALS:
  /// Comes from another thread.
  void Answered(bool success, const QString& message);

 private:
  void Ask(std::function<Answer()> request);
  void ShowAnswer(bool success, const QString& message);
  void ShowStatus(const train_brake_msgs::RunStatus& status);
  void ShowSelection(const train_brake_msgs::ViewSelection& selection);

  QPushButton *play_, *pause_, *step_;
  QSpinBox* exchanges_;
  QDoubleSpinBox* pace_;
  QComboBox *quantity_, *vehicle_;
  QLabel* message_;

  ros::NodeHandle train_{ros::this_node::getNamespace() == "/" ? "/train" : ros::this_node::getNamespace()};
  RunClient client_{train_};
  ros::Subscriber status_, selection_;
  Worker worker_;  ///< uses client_, so it ends before
};

}  // namespace train_brake_rviz
