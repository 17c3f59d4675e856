#include "train_brake_rviz/run_panel.h"

#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStyle>
#include <pluginlib/class_list_macros.hpp>

namespace train_brake_rviz {
namespace {

using train_brake_msgs::RunStatus;
using train_brake_msgs::ViewSelection;

QPushButton* MakeButton(QHBoxLayout* row, const QString& name, QStyle::StandardPixmap icon, const QString& tip) {
  auto* button = new QPushButton(QApplication::style()->standardIcon(icon), name);
  button->setObjectName(name);
  button->setToolTip(tip);
  button->setEnabled(false);
  row->addWidget(button);
  return button;
}

template <class Widget>
Widget* Add(QHBoxLayout* row, const QString& label, const QString& name) {
  row->addSpacing(12);
  if (!label.isEmpty()) row->addWidget(new QLabel(label));
  auto* widget = new Widget;
  widget->setObjectName(name);
  widget->setEnabled(false);
  row->addWidget(widget);
  return widget;
}

constexpr const char* kReady = "ready: press Play";

/// "coupler_force" for people.
QString Spoken(const std::string& name) { return QString::fromStdString(name).replace('_', ' '); }

}  // namespace

RunPanel::RunPanel(QWidget* parent) : rviz::Panel(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 8, 4);
  play_ = MakeButton(row, "Play", QStyle::SP_MediaPlay, "Let the train run");
  pause_ = MakeButton(row, "Pause", QStyle::SP_MediaPause, "Hold the train where it is");
  step_ = MakeButton(row, "Step", QStyle::SP_MediaSeekForward, "Let a paused train move on a little");
  exchanges_ = Add<QSpinBox>(row, "", "Exchanges");
  exchanges_->setRange(1, 10000);
  exchanges_->setValue(10);
  exchanges_->setSuffix(" exchanges");
  pace_ = Add<QDoubleSpinBox>(row, "times real time", "Pace");
  pace_->setRange(0.0, 1000.0);
  pace_->setSpecialValueText("as fast as possible");  // of 0
  pace_->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  pace_->setKeyboardTracking(false);
  quantity_ = Add<QComboBox>(row, "colour", "Quantity");
  quantity_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  vehicle_ = Add<QComboBox>(row, "close-up of vehicle", "Vehicle");
  vehicle_->setEditable(true);
  vehicle_->setInsertPolicy(QComboBox::NoInsert);
  vehicle_->setToolTip("Listed: vehicles recorded in full detail. Any other number can be typed.");
  message_ = new QLabel("no train is running");
  row->addSpacing(12);
  row->addWidget(message_, 1);

  connect(this, &RunPanel::Answered, this, &RunPanel::ShowAnswer);
  connect(play_, &QPushButton::clicked, [this] { Ask([this] { return client_.Resume(); }); });
  connect(pause_, &QPushButton::clicked, [this] { Ask([this] { return client_.Pause(); }); });
  connect(step_, &QPushButton::clicked, [this] {
    const auto exchanges = static_cast<unsigned>(exchanges_->value());
    Ask([this, exchanges] { return client_.Step(exchanges); });
  });
  connect(pace_, qOverload<double>(&QDoubleSpinBox::valueChanged),
          [this](double factor) { Ask([this, factor] { return client_.SetRealTimeFactor(factor); }); });
  connect(quantity_, qOverload<int>(&QComboBox::activated), [this] {
    const std::string quantity = quantity_->currentData().toString().toStdString();
    Ask([this, quantity] { return client_.Select(quantity, 0); });
  });
  const auto follow = [this] {
    const int vehicle = vehicle_->currentText().toInt();
    Ask([this, vehicle] { return client_.Select("", vehicle); });
  };
  connect(vehicle_, qOverload<int>(&QComboBox::activated), follow);
  connect(vehicle_->lineEdit(), &QLineEdit::returnPressed, follow);

  status_ = train_.subscribe("live/status", 1, &RunPanel::ShowStatus, this);
  selection_ = train_.subscribe("view/selection", 1, &RunPanel::ShowSelection, this);
}

void RunPanel::Ask(std::function<Answer()> request) {
  worker_.Do([this, request = std::move(request)] {
    const Answer answer = request();
    Q_EMIT Answered(answer.success, QString::fromStdString(answer.message));
  });
}

void RunPanel::ShowAnswer(bool success, const QString& message) {
  message_->setText(message);
  message_->setStyleSheet(success ? "" : "color: #d55e00");  // vermillion
}

void RunPanel::ShowStatus(const RunStatus& status) {
  const bool paused = status.state == RunStatus::PAUSED, ended = status.state == RunStatus::ENDED;
  const bool was_known = pause_->isEnabled() || play_->isEnabled();
  play_->setEnabled(paused);
  step_->setEnabled(paused);
  exchanges_->setEnabled(paused);
  pause_->setEnabled(!paused && !ended);
  pace_->setEnabled(!ended);
  if (!pace_->hasFocus()) {  // not while a user types
    const QSignalBlocker quiet(pace_);
    pace_->setValue(status.wanted_real_time_factor);
  }
  if (ended) ShowAnswer(true, "the run has ended");
  if (!ended && !was_known) ShowAnswer(true, paused ? kReady : "");
  if (!paused && message_->text() == kReady) ShowAnswer(true, "");
}

void RunPanel::ShowSelection(const ViewSelection& selection) {
  if (!train_.param("view/live", true)) ShowAnswer(true, "a recording: no run to control");
  quantity_->setEnabled(true);
  quantity_->clear();
  for (const std::string& name : selection.quantities) {
    quantity_->addItem(Spoken(name), QString::fromStdString(name));
  }
  quantity_->setCurrentIndex(quantity_->findData(QString::fromStdString(selection.quantity)));
  vehicle_->setEnabled(selection.vehicles > 0);
  vehicle_->clear();
  for (const std::uint32_t vehicle : selection.detailed) vehicle_->addItem(QString::number(vehicle));
  vehicle_->setCurrentText(QString::number(selection.vehicle));
}

}  // namespace train_brake_rviz

PLUGINLIB_EXPORT_CLASS(train_brake_rviz::RunPanel, rviz::Panel)
