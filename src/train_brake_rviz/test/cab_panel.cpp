#include "train_brake_rviz/cab_panel.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <train_brake_msgs/GivenCommand.h>

#include <QApplication>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QTest>
#include <functional>
#include <vector>

namespace train_brake_rviz {
namespace {

using train_brake_msgs::DriverView;
using train_brake_msgs::GivenCommand;

/// The cab of a running train. What became of a lever is learnt from the train's own topics.
class CabPanelTest : public testing::Test {
 protected:
  CabPanelTest() {
    given_subscriber_ = node_.subscribe<GivenCommand>(
        "/train/driver/given", 100, [this](const GivenCommand::ConstPtr& message) { given_.push_back(*message); });
    view_subscriber_ = node_.subscribe<DriverView>("/train/live/driver_view", 1,
                                                   [this](const DriverView::ConstPtr& message) { view_ = *message; });
    panel_.show();
    width_before_ = panel_.sizeHint().width();
  }
  void SetUp() override {
    ASSERT_TRUE(
        Comes([this] { return Find<QPushButton>("Release").isEnabled() && Find<QSlider>("Throttle").isEnabled(); }));
  }

  /// Lets messages and events come until the condition holds.
  bool Comes(const std::function<bool()>& condition, double timeout_s = 600.0) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(timeout_s);
    while (!condition()) {
      if (ros::WallTime::now() > end) return false;
      ros::spinOnce();
      QTest::qWait(10);
    }
    return true;
  }
  template <class Widget>
  Widget& Find(const char* name) {
    auto* widget = panel_.findChild<Widget*>(name);
    if (widget == nullptr) throw std::runtime_error(std::string("the panel has no ") + name);
    return *widget;
  }
  QString Text(const char* name) { return Find<QLabel>(name).text(); }
  bool WasGiven(const std::string& kind, double value) {
    for (const GivenCommand& given : given_) {
      const auto& command = given.command;
      if (command.kind == kind && (kind == "apply" ? command.reduction_kpa : command.notch) == value) return given.live;
    }
    return false;
  }

  ros::NodeHandle node_;
  ros::Subscriber given_subscriber_, view_subscriber_;
  std::vector<GivenCommand> given_;
  DriverView view_;
  CabPanel panel_;
  int width_before_ = 0;  ///< that the panel asks for before anything is shown [pixel]
};

TEST_F(CabPanelTest, ShowsWhatADriverSees) {
  EXPECT_TRUE(Comes([this] { return Text("Limit") == "60 km/h" && Text("Ahead").startsWith("20 km/h in "); }));
  EXPECT_TRUE(Comes([this] { return Text("Speed") == QString::number(3.6 * view_.speed_mps, 'f', 1) + " km/h"; }));
  EXPECT_TRUE(Comes([this] { return Text("BrakePipe") == "not computed" && Text("Cylinder") == "0 kPa; 0 kPa"; }));
  EXPECT_TRUE(Comes([this] { return Text("Forces").endsWith(" kN"); }));
  EXPECT_TRUE(Comes([this] { return Text("Message").isEmpty(); }));
}

TEST_F(CabPanelTest, NoTextMakesItWiderOrIsCut) {
  for (const char* name : {"Limit", "Ahead", "Grade", "Effort", "Handle", "BrakePipe", "Cylinder", "Forces"}) {
    EXPECT_TRUE(Comes([&] { return Text(name) != "-"; })) << name;
    const auto& value = Find<QLabel>(name);
    EXPECT_LE(value.fontMetrics().horizontalAdvance(value.text()), value.width()) << name;
  }
  EXPECT_EQ(width_before_, panel_.sizeHint().width());
  Find<QDoubleSpinBox>("Reduction").setMaximum(5000.0);
  const int width = panel_.sizeHint().width();
  Find<QDoubleSpinBox>("Reduction").setValue(5000.0);
  Find<QPushButton>("Apply").click();
  EXPECT_TRUE(Comes([this] { return !Text("Message").isEmpty(); }));
  EXPECT_EQ(width, panel_.sizeHint().width());
}

TEST_F(CabPanelTest, LeversAreObeyed) {
  auto& throttle = Find<QSlider>("Throttle");
  EXPECT_EQ(8, throttle.maximum());
  throttle.setFocus();
  QTest::keyClick(&throttle, Qt::Key_End);
  EXPECT_TRUE(Comes([this] { return WasGiven("throttle", 8.0); }));
  EXPECT_TRUE(Comes([&] { return view_.throttle_notch == 8.0 && throttle.value() == 8; }));
  EXPECT_TRUE(Comes([this] { return Text("ThrottleNotch") == "8 of 8" && view_.effort_n > 0.0; }));
  QTest::keyClick(&throttle, Qt::Key_Home);
  EXPECT_TRUE(Comes([this] { return view_.throttle_notch == 0.0; }));
  // Who else moves the lever moves this one.
  train_brake_msgs::DriverCommand command;
  command.kind = "throttle";
  command.notch = 3;
  EXPECT_TRUE(RunClient(ros::NodeHandle("/train")).Give(command).success);
  EXPECT_TRUE(Comes([&] { return throttle.value() == 3; }));
}

TEST_F(CabPanelTest, TheBrakeHandle) {
  Find<QDoubleSpinBox>("Reduction").setValue(70.0);
  Find<QPushButton>("Apply").click();
  EXPECT_TRUE(Comes([this] { return WasGiven("apply", 70.0); }));
  EXPECT_TRUE(Comes([this] { return Text("Handle") == "reduction 70 kPa" && view_.mean_cylinder_kpa > 1.0; }));
  Find<QPushButton>("Emergency").click();
  EXPECT_TRUE(Comes([this] { return Text("Handle") == "EMERGENCY"; }));
  Find<QPushButton>("Release").click();
  EXPECT_TRUE(Comes([this] { return Text("Handle") == "released"; }));
}

TEST_F(CabPanelTest, WhatIsRefusedIsTold) {
  Find<QDoubleSpinBox>("Reduction").setMaximum(5000.0);
  Find<QDoubleSpinBox>("Reduction").setValue(5000.0);
  Find<QPushButton>("Apply").click();
  EXPECT_TRUE(Comes([this] { return Text("Message").contains("reduction_kpa must be"); }));
}

}  // namespace
}  // namespace train_brake_rviz

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "cab_panel_test");
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
