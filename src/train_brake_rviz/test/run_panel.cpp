#include "train_brake_rviz/run_panel.h"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTest>
#include <algorithm>
#include <functional>

namespace train_brake_rviz {
namespace {

using train_brake_msgs::RunStatus;
using train_brake_msgs::ViewSelection;

/// The panel beside a running, paused train of six vehicles. What became of a click is learnt from the train's
/// own topics.
class RunPanelTest : public testing::Test {
 protected:
  RunPanelTest() {
    status_subscriber_ = node_.subscribe<RunStatus>("/train/live/status", 1,
                                                    [this](const RunStatus::ConstPtr& message) { status_ = *message; });
    selection_subscriber_ = node_.subscribe<ViewSelection>(
        "/train/view/selection", 1, [this](const ViewSelection::ConstPtr& message) { selection_ = *message; });
    panel_.show();
  }

  void SetUp() override {
    ASSERT_TRUE(Comes([this] { return selection_.vehicles == 6 && vehicle().isEnabled(); }));
    ASSERT_TRUE(Comes([this] { return play().isEnabled() || pause().isEnabled(); }));
    if (pause().isEnabled()) pause().click();
    ASSERT_TRUE(Comes([this] { return status_.state == RunStatus::PAUSED && play().isEnabled(); }));
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
  QPushButton& play() { return Find<QPushButton>("Play"); }
  QPushButton& pause() { return Find<QPushButton>("Pause"); }
  QPushButton& step() { return Find<QPushButton>("Step"); }
  QComboBox& vehicle() { return Find<QComboBox>("Vehicle"); }
  bool Says(const QString& text) {
    for (const QLabel* label : panel_.findChildren<QLabel*>()) {
      if (label->text().contains(text)) return true;
    }
    return false;
  }
  void Type(const char* text) {
    QLineEdit* line = vehicle().lineEdit();
    line->selectAll();
    QTest::keyClicks(line, text);
    QTest::keyClick(line, Qt::Key_Return);
  }

  ros::NodeHandle node_;
  ros::Subscriber status_subscriber_, selection_subscriber_;
  RunStatus status_;
  ViewSelection selection_;
  RunPanel panel_;
};

TEST_F(RunPanelTest, PlayAndPause) {
  EXPECT_FALSE(pause().isEnabled());
  play().click();
  const auto begin = status_.exchange;
  ASSERT_TRUE(Comes([&] { return status_.state == RunStatus::RUNNING && status_.exchange > begin + 20; }));
  EXPECT_TRUE(Comes([this] { return pause().isEnabled() && !play().isEnabled() && !step().isEnabled(); }));
  pause().click();
  ASSERT_TRUE(Comes([this] { return status_.state == RunStatus::PAUSED; }));
  EXPECT_TRUE(Comes([this] { return !pause().isEnabled() && play().isEnabled() && step().isEnabled(); }));
  const auto held = status_.exchange;
  Comes([] { return false; }, 0.5);
  EXPECT_EQ(held, status_.exchange);
}

TEST_F(RunPanelTest, InvitesToPlayOnlyWhileTheTrainWaits) {
  RunPanel other;  // which begins with a paused train
  const auto invites = [&other] {
    const QList<QLabel*> labels = other.findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(),
                       [](const QLabel* label) { return label->text() == "ready: press Play"; });
  };
  ASSERT_TRUE(Comes(invites));
  EXPECT_TRUE(RunClient(ros::NodeHandle("/train")).Resume().success);  // by another client
  EXPECT_TRUE(Comes([&] { return !invites(); }));
}

TEST_F(RunPanelTest, SaysThatARecordingIsNotControlled) {
  node_.setParam("/train/view/live", false);
  RunPanel of_a_bag;
  EXPECT_TRUE(Comes([&of_a_bag] {
    const QList<QLabel*> labels = of_a_bag.findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(),
                       [](const QLabel* label) { return label->text() == "a recording: no run to control"; });
  }));
  node_.deleteParam("/train/view/live");
}

TEST_F(RunPanelTest, StepMovesThePausedTrainByTheChosenExchanges) {
  const auto begin = status_.exchange;
  Find<QSpinBox>("Exchanges").setValue(35);  // records come with every fifth exchange
  step().click();
  ASSERT_TRUE(Comes([&] { return status_.exchange >= begin + 31; }));
  Comes([] { return false; }, 0.3);
  EXPECT_LE(status_.exchange, begin + 35);
  EXPECT_EQ(RunStatus::PAUSED, status_.state);
}

TEST_F(RunPanelTest, PaceIsTheMasters) {
  auto& pace = Find<QDoubleSpinBox>("Pace");
  EXPECT_TRUE(Comes([&] { return pace.value() == status_.wanted_real_time_factor; }));
  for (const double factor : {2.5, 0.0, 1.0}) {
    pace.setValue(factor);
    EXPECT_TRUE(Comes([&] { return status_.wanted_real_time_factor == factor; })) << factor;
  }
}

TEST_F(RunPanelTest, QuantityIsTheViews) {
  auto& quantity = Find<QComboBox>("Quantity");
  ASSERT_EQ(5, quantity.count());
  QTest::keyClick(&quantity, Qt::Key_End);
  EXPECT_TRUE(Comes([this] { return selection_.quantity == "acceleration"; }));
  QTest::keyClick(&quantity, Qt::Key_Home);
  EXPECT_TRUE(Comes([this] { return selection_.quantity == "coupler_force"; }));
}

TEST_F(RunPanelTest, AnyVehicleOfTheTrainCanBeFollowed) {
  Type("3");
  EXPECT_TRUE(Comes([this] { return selection_.vehicle == 3; }));
  Type("99");
  EXPECT_TRUE(Comes([this] { return Says("vehicle 99 is not in a train of 6 vehicles"); }));
  EXPECT_EQ(3u, selection_.vehicle);
}

TEST_F(RunPanelTest, SaysWhenNobodyAnswers) {
  RunClient nowhere{ros::NodeHandle("/nowhere")};
  const Answer answer = nowhere.Pause();
  EXPECT_FALSE(answer.success);
  EXPECT_EQ("/nowhere/master/pause does not answer", answer.message);
}

}  // namespace
}  // namespace train_brake_rviz

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "run_panel_test");
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
