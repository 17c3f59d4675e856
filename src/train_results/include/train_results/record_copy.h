#pragma once

#include <optional>
#include <vector>

#include "train_dynamics/train/train_master.h"

namespace train_results {

/// A record that outlives its exchange. Energies of single vehicles are left out.
class RecordCopy {
 public:
  /// Keeps its memory from record to record.
  RecordCopy& operator=(const train_dynamics::TrainRecord& record);

  /// The record; refers to this copy.
  train_dynamics::TrainRecord View() const;

 private:
  double time_s_ = 0.0;
  std::uint64_t exchange_ = 0;
  double mean_speed_mps_ = 0.0, mean_position_m_ = 0.0;
  train_dynamics::ExchangeReply vehicles_{0, {}};
  std::vector<double> acceleration_mps2_, coupler_force_n_, coupler_extension_m_, cylinder_pressure_pa_,
      held_pressure_pa_;
  std::uint64_t state_digest_ = 0;
  std::optional<train_dynamics::EnergyLedger> ledger_;
};

}  // namespace train_results
