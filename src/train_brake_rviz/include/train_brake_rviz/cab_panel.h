#pragma once

#include <ros/subscriber.h>
#include <ros/this_node.h>
#include <rviz/panel.h>
#include <train_brake_msgs/DriverView.h>
#include <train_brake_msgs/RunStatus.h>

#include <functional>

#include "train_brake_rviz/run_client.h"

class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSlider;

namespace train_brake_rviz {

/// The cab of a train in rviz: throttle, dynamic brake and brake handle; speed, limits and grade ahead, pressures,
/// in-train forces. The train is the one in the namespace of rviz's node; for an rviz in no namespace, /train.
///
/// The controls show what the train obeys (live/driver_view), whatever its source, and give commands by driver/give;
/// refusals are shown in the last line. Messages must arrive in the window's thread, as they do in rviz.
class CabPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit CabPanel(QWidget* parent = nullptr);

 Q_SIGNALS:
  /// Comes from another thread.
  void Answered(bool success, const QString& message);

 private:
  void Give(const train_brake_msgs::DriverCommand& command);
  void ShowAnswer(bool success, const QString& message);
  void ShowView(const train_brake_msgs::DriverView& view);
  void ShowStatus(const train_brake_msgs::RunStatus& status);
  QLabel* AddLine(const QString& label, const QString& name);
  QSlider* AddLever(const QString& label, const QString& name, const std::string& kind);
  void SetLever(QSlider* lever, double notch, double notches);

  QLabel *speed_, *limit_, *ahead_, *grade_, *effort_, *handle_, *pipe_, *cylinder_, *forces_, *message_;
  QSlider *throttle_, *dynamic_brake_;
  QDoubleSpinBox* reduction_;
  QPushButton *apply_, *release_, *emergency_;

  ros::NodeHandle train_{ros::this_node::getNamespace() == "/" ? "/train" : ros::this_node::getNamespace()};
  RunClient client_{train_};
  ros::Subscriber view_, status_;
  Worker worker_;  ///< uses client_, so it ends before
};

}  // namespace train_brake_rviz
