#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "train_dynamics/traction/slip_control.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics {

/// Slip control of the locomotives of a batch: between the traction that the master sends and the driven wheelsets.
/// Runs vehicle by vehicle, before each step.
template <class Vehicle>
class BatchSlipControl {
 public:
  static constexpr int kWheelsets = Vehicle::kWheelsets;
  using State = std::array<double, kWheelsets>;  ///< reduction of each wheelset
  /// Numbers in the state of a vehicle.
  static constexpr int kNumbers = kWheelsets;

  BatchSlipControl(const SlipControlParams& params, double dt, const VehicleBatch<Vehicle>& batch)
      : params_(params),
        steps_per_sample_(std::lround(params.sampling_period_s / dt)),
        lanes_(batch.lanes()),
        states_(batch.size()),
        share_((static_cast<std::size_t>(batch.size() + lanes_ - 1) / lanes_) * lanes_ * kMostWheelsets, 1.0) {}

  /// Samples at the start of the step that comes.
  /// @param step  counted from the start of the run
  /// @return the shares over that step, as LoadPlaces takes them
  const double* Step(long step, const VehicleBatch<Vehicle>& batch) {
    if (step % steps_per_sample_ != 0) return share_.data();
    const double radius_m = batch.vehicle().rolling.radius_m;
    for (int i = 0; i < batch.size(); ++i) {
      const double speed_mps = batch.NumberOf(i, Vehicle::kSpeed);
      for (int j = 0; j < kWheelsets; ++j) {
        const double wheel_mps = radius_m * batch.NumberOf(i, Vehicle::kFirstSpin + j);
        states_[i][j] = NextReduction(params_, states_[i][j], speed_mps, wheel_mps);
      }
    }
    ShareOut();
    return share_.data();
  }

  const State& StateOf(int i) const { return states_[i]; }
  void SetState(int i, const State& state) {
    states_[i] = state;
    ShareOut();
  }

 private:
  /// Vehicles that fill up the last pack do what its first one does.
  void ShareOut() {
    const int vehicles = static_cast<int>(states_.size());
    for (int i = 0; i < static_cast<int>(share_.size()) / kMostWheelsets; ++i) {
      const int pack = i / lanes_, lane = i % lanes_, of = i < vehicles ? i : pack * lanes_;
      for (int j = 0; j < kWheelsets; ++j) {
        share_[(static_cast<std::size_t>(pack) * kMostWheelsets + j) * lanes_ + lane] = 1.0 - states_[of][j];
      }
    }
  }

  SlipControlParams params_;
  long steps_per_sample_;
  int lanes_;
  std::vector<State> states_;
  std::vector<double> share_;  ///< [pack][kMostWheelsets][lane]
};

}  // namespace train_dynamics
