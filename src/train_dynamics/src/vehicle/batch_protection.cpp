#include "train_dynamics/vehicle/batch_protection.h"

#include <array>

namespace train_dynamics {

template <class Vehicle>
BatchProtection<Vehicle>::BatchProtection(const SlideProtectionParams& params, double dt,
                                          const VehicleBatch<Vehicle>& batch)
    : protection_(params, dt),
      lanes_(batch.lanes()),
      states_(batch.size()),
      pressure_pa_(static_cast<std::size_t>(PaddedToLanes(batch.size())) * kMostWheelsets, 0.0) {}

template <class Vehicle>
const double* BatchProtection<Vehicle>::Step(long step, const VehicleBatch<Vehicle>& batch, const double* supply_pa) {
  const double radius_m = batch.vehicle().rolling.radius_m;
  const bool samples = protection_.Samples(step);
  const auto place = [this](int vehicle, int wheelset) -> double& {
    const int pack = vehicle / lanes_, lane = vehicle % lanes_;
    return pressure_pa_[(static_cast<std::size_t>(pack) * kMostWheelsets + wheelset) * lanes_ + lane];
  };
  for (int i = 0; i < batch.size(); ++i) {
    State& state = states_[i];
    if (samples) {
      std::array<double, kWheelsets> wheel_speed_mps;
      for (int j = 0; j < kWheelsets; ++j) {
        wheel_speed_mps[j] = radius_m * batch.NumberOf(i, Vehicle::kFirstSpin + j);
      }
      protection_.Sample(step, batch.NumberOf(i, Vehicle::kSpeed), wheel_speed_mps, state);
    }
    protection_.Step(step, supply_pa[i], state);
    for (int j = 0; j < kWheelsets; ++j) place(i, j) = state.wheelset[j].pressure_pa;
  }
  const int first_of_last_pack = (batch.size() - 1) / lanes_ * lanes_;
  for (int spare = batch.size(); spare < first_of_last_pack + lanes_; ++spare) {
    for (int j = 0; j < kWheelsets; ++j) place(spare, j) = place(first_of_last_pack, j);
  }
  return pressure_pa_.data();
}

template class BatchProtection<Wagon>;
template class BatchProtection<SixAxleVehicle>;

}  // namespace train_dynamics
