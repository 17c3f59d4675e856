#include "train_dynamics/brake/brake_pressures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "train_dynamics/brake/brake_kernels.h"

namespace train_dynamics {

BrakePressures::BrakePressures(AirBrake brake, double dt_s, int steps)
    : brake_(std::move(brake)), dt_s_(dt_s), steps_(steps) {
  TakePhases();
}

void BrakePressures::Command(const BrakeCommand& command) {
  brake_.Command(command);
  TakePhases();
}

void BrakePressures::OpenPipe(double time_s, int connection) {
  brake_.OpenPipe(time_s, connection);
  TakePhases();
}

void BrakePressures::TakePhases() {
  window_ = -1;
  const BrakePhases phases = brake_.Phases();
  begin_s_.assign(phases.begin_s, phases.begin_s + phases.phases * phases.stride);
  std::sort(begin_s_.begin(), begin_s_.end());
  for (std::vector<double>* array : {&target_pa_, &gap_pa_, &decay_}) array->resize(phases.stride);
}

void BrakePressures::BeginWindow(long window) {
  window_ = window;
  at_ = window * steps_;
  const double begin_s = static_cast<double>(at_) * dt_s_;
  const double end_s = static_cast<double>(at_ + steps_) * dt_s_;
  const auto next = std::upper_bound(begin_s_.begin(), begin_s_.end(), begin_s);
  by_law_ = next != begin_s_.end() && *next <= end_s;
  if (by_law_) return;
  const BrakePhases phases = brake_.Phases();
  BestBrakeKernels().cylinder_gaps(phases, begin_s, dt_s_, phases.stride,
                                   {target_pa_.data(), gap_pa_.data(), decay_.data()});
}

void BrakePressures::PressuresAt(double time_s, std::vector<double>& pressure_pa) {
  const long at = std::lround(time_s / dt_s_);
  const long window = at / steps_;
  if (window != window_ || at < at_) BeginWindow(window);
  const BrakePhases phases = brake_.Phases();
  pressure_pa.resize(phases.stride);  // whole packs of lanes
  if (by_law_) {
    BestBrakeKernels().cylinder_pressures(phases, static_cast<double>(at) * dt_s_, phases.stride, pressure_pa.data());
  } else {
    BestBrakeKernels().close_cylinder_gaps(static_cast<int>(at - at_), phases.stride,
                                           {target_pa_.data(), gap_pa_.data(), decay_.data()}, pressure_pa.data());
    at_ = at;
  }
  pressure_pa.resize(brake_.vehicles());
}

}  // namespace train_dynamics
