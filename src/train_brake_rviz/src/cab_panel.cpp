#include "train_brake_rviz/cab_panel.h"

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

namespace train_brake_rviz {
namespace {

using train_brake_msgs::DriverCommand;
using train_brake_msgs::DriverView;
using train_brake_msgs::RunStatus;

constexpr double kKmhPerMps = 3.6;
constexpr const char* kWidestValue = "-88.8 \u2030; no change in sight";
constexpr double kFirstReduction = 50.0, kFullReduction = 200.0;  // [kPa]

QString Number(double value, int decimals) { return QString::number(value, 'f', decimals); }
QString Kmh(double mps) { return std::isfinite(mps) ? Number(kKmhPerMps * mps, 0) + " km/h" : QString("none"); }
QString Distance(double m) { return m < 1000.0 ? Number(m, 0) + " m" : Number(1e-3 * m, 1) + " km"; }
QString KiloPascal(double kpa) { return std::isfinite(kpa) ? Number(kpa, 0) + " kPa" : QString("not computed"); }

/// The next value of a quantity that changes along the line: "80 km/h in 1.2 km".
template <class Text>
QString Next(const std::vector<double>& from_m, const std::vector<double>& values, double front_m, const Text& text) {
  if (from_m.empty() || values.size() != from_m.size()) return "no change in sight";
  return text(values.front()) + " in " + Distance(from_m.front() - front_m);
}

}  // namespace

CabPanel::CabPanel(QWidget* parent) : rviz::Panel(parent) {
  auto* column = new QVBoxLayout(this);
  speed_ = new QLabel("- km/h");
  speed_->setObjectName("Speed");
  speed_->setStyleSheet("font-size: 28px; font-weight: bold");
  column->addWidget(speed_);
  limit_ = AddLine("limit", "Limit");
  ahead_ = AddLine("next limit", "Ahead");
  grade_ = AddLine("grade", "Grade");
  throttle_ = AddLever("throttle", "Throttle", "throttle");
  dynamic_brake_ = AddLever("dynamic brake", "DynamicBrake", "dynamic_brake");
  effort_ = AddLine("effort", "Effort");

  auto* brake = new QHBoxLayout;
  column->addLayout(brake);
  const auto add_button = [brake](const QString& text, const QString& name) {
    auto* button = new QPushButton(text);
    button->setObjectName(name);
    button->setEnabled(false);
    brake->addWidget(button);
    return button;
  };
  release_ = add_button("Release", "Release");
  apply_ = add_button("Apply", "Apply");
  reduction_ = new QDoubleSpinBox;
  reduction_->setObjectName("Reduction");
  reduction_->setRange(1.0, kFullReduction);
  reduction_->setValue(kFirstReduction);
  reduction_->setSingleStep(10.0);
  reduction_->setDecimals(0);
  reduction_->setSuffix(" kPa");
  reduction_->setToolTip("Reduction of the brake pipe's pressure in total");
  brake->addWidget(reduction_);
  emergency_ = new QPushButton("EMERGENCY");
  emergency_->setObjectName("Emergency");
  emergency_->setEnabled(false);
  emergency_->setStyleSheet("QPushButton:enabled { background: #d55e00; color: white; font-weight: bold }");
  column->addWidget(emergency_);
  handle_ = AddLine("brake handle", "Handle");
  pipe_ = AddLine("brake pipe", "BrakePipe");
  cylinder_ = AddLine("cylinder; mean", "Cylinder");
  forces_ = AddLine("in-train forces", "Forces");
  message_ = new QLabel("no train is running");
  message_->setObjectName("Message");
  message_->setWordWrap(true);
  message_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  column->addWidget(message_);
  column->addStretch(1);

  connect(this, &CabPanel::Answered, this, &CabPanel::ShowAnswer);
  const auto gives = [this](QPushButton* button, const char* kind) {
    connect(button, &QPushButton::clicked, [this, kind] {
      DriverCommand command;
      command.kind = kind;
      command.reduction_kpa = reduction_->value();
      Give(command);
    });
  };
  gives(release_, "release");
  gives(apply_, "apply");
  gives(emergency_, "emergency");
  view_ = train_.subscribe("live/driver_view", 1, &CabPanel::ShowView, this);
  status_ = train_.subscribe("live/status", 1, &CabPanel::ShowStatus, this);
}

QLabel* CabPanel::AddLine(const QString& label, const QString& name) {
  auto* row = new QHBoxLayout;
  static_cast<QVBoxLayout*>(layout())->addLayout(row);
  row->addWidget(new QLabel(label));
  auto* value = new QLabel("-");
  value->setObjectName(name);
  value->setAlignment(Qt::AlignRight);
  // No text makes the panel wider, and so the train beside it smaller.
  value->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  value->setMinimumWidth(value->fontMetrics().horizontalAdvance(kWidestValue));
  row->addWidget(value, 1);
  return value;
}

QSlider* CabPanel::AddLever(const QString& label, const QString& name, const std::string& kind) {
  QLabel* notch = AddLine(label, name + "Notch");
  auto* lever = new QSlider(Qt::Horizontal);
  lever->setObjectName(name);
  lever->setEnabled(false);
  lever->setPageStep(1);
  lever->setTickPosition(QSlider::TicksBelow);
  lever->setTickInterval(1);
  layout()->addWidget(lever);
  connect(lever, &QSlider::valueChanged, [this, notch, kind](int value) {
    notch->setText(QString::number(value));
    DriverCommand command;
    command.kind = kind;
    command.notch = value;
    Give(command);
  });
  return lever;
}

void CabPanel::Give(const DriverCommand& command) {
  worker_.Do([this, command] {
    const Answer answer = client_.Give(command);
    Q_EMIT Answered(answer.success, QString::fromStdString(answer.message));
  });
}

void CabPanel::ShowAnswer(bool success, const QString& message) {
  message_->setText(success ? "" : message);
  message_->setStyleSheet(success ? "" : "color: #d55e00");  // vermillion
}

void CabPanel::SetLever(QSlider* lever, double notch, double notches) {
  lever->setEnabled(notches > 0.0);
  if (lever->isSliderDown()) return;  // a user holds it
  const QSignalBlocker quiet(lever);
  lever->setRange(0, static_cast<int>(std::lround(notches)));
  lever->setValue(static_cast<int>(std::lround(notch)));
  findChild<QLabel*>(lever->objectName() + "Notch")->setText(Number(notch, 0) + " of " + Number(notches, 0));
}

void CabPanel::ShowView(const DriverView& view) {
  speed_->setText(Number(kKmhPerMps * view.speed_mps, 1) + " km/h");
  const bool too_fast = view.speed_mps > view.speed_limit_mps;
  speed_->setStyleSheet(QString("font-size: 28px; font-weight: bold; color: %1").arg(too_fast ? "#d55e00" : "black"));
  limit_->setText(Kmh(view.speed_limit_mps));
  ahead_->setText(Next(view.limit_from_m, view.limit_mps, view.front_m, Kmh));
  const auto permille = [](double grade) { return Number(1e3 * grade, 1) + " \u2030"; };
  grade_->setText(permille(view.mean_grade) + "; " + Next(view.grade_from_m, view.grade, view.front_m, permille));
  SetLever(throttle_, view.throttle_notch, view.throttle_notches);
  SetLever(dynamic_brake_, view.dynamic_brake_notch, view.dynamic_brake_notches);
  effort_->setText(Number(1e-3 * view.effort_n, 0) + " kN");
  handle_->setText(view.emergency             ? QString("EMERGENCY")
                   : view.reduction_kpa > 0.0 ? "reduction " + KiloPascal(view.reduction_kpa)
                                              : QString("released"));
  pipe_->setText(KiloPascal(view.brake_pipe_kpa));
  cylinder_->setText(KiloPascal(view.cylinder_kpa) + "; " + KiloPascal(view.mean_cylinder_kpa));
}

void CabPanel::ShowStatus(const RunStatus& status) {
  const bool runs = status.state != RunStatus::ENDED;
  for (QPushButton* button : {apply_, release_, emergency_}) button->setEnabled(runs);
  forces_->setText(Number(1e-3 * status.max_tension_n, 0) + " kN, " + Number(1e-3 * status.max_compression_n, 0) +
                   " kN");
  if (!runs) ShowAnswer(false, "the run has ended");
  if (runs && message_->text() == "no train is running") ShowAnswer(true, "");
}

}  // namespace train_brake_rviz

PLUGINLIB_EXPORT_CLASS(train_brake_rviz::CabPanel, rviz::Panel)
