#include "train_results/record_copy.h"

namespace train_results {

RecordCopy& RecordCopy::operator=(const train_dynamics::TrainRecord& record) {
  time_s_ = record.time_s;
  exchange_ = record.exchange;
  mean_speed_mps_ = record.mean_speed_mps;
  mean_position_m_ = record.mean_position_m;
  const train_dynamics::ExchangeReply& vehicles = record.vehicles;
  vehicles_.head_displacement_m = vehicles.head_displacement_m;
  vehicles_.head_velocity_mps = vehicles.head_velocity_mps;
  vehicles_.position_m = vehicles.position_m;
  vehicles_.speed_mps = vehicles.speed_mps;
  vehicles_.shoe_force_n = vehicles.shoe_force_n;
  vehicles_.wheel_force_n = vehicles.wheel_force_n;
  vehicles_.creepage = vehicles.creepage;
  vehicles_.state_digest = vehicles.state_digest;
  vehicles_.details = vehicles.details;
  acceleration_mps2_ = record.acceleration_mps2;
  coupler_force_n_ = record.coupler_force_n;
  coupler_extension_m_ = record.coupler_extension_m;
  cylinder_pressure_pa_ = record.cylinder_pressure_pa;
  held_pressure_pa_ = record.held_pressure_pa;
  state_digest_ = record.state_digest;
  ledger_.reset();
  if (record.ledger != nullptr) ledger_ = *record.ledger;
  return *this;
}

train_dynamics::TrainRecord RecordCopy::View() const {
  return {time_s_,
          exchange_,
          mean_speed_mps_,
          mean_position_m_,
          vehicles_,
          acceleration_mps2_,
          coupler_force_n_,
          coupler_extension_m_,
          cylinder_pressure_pa_,
          held_pressure_pa_,
          state_digest_,
          ledger_.has_value() ? &*ledger_ : nullptr};
}

}  // namespace train_results
