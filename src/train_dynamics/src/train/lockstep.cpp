#include "train_dynamics/train/lockstep.h"

namespace train_dynamics {

ExchangeReply::ExchangeReply(int vehicles, const std::vector<int>& detailed) {
  for (std::vector<double>* array : {&head_displacement_m, &head_velocity_mps, &position_m, &speed_mps,
                                     &shoe_force_n, &wheel_force_n, &creepage}) {
    array->resize(vehicles);
  }
  state_digest.resize(vehicles);
  energy.resize(vehicles);
  details.resize(detailed.size());
  for (size_t i = 0; i < detailed.size(); ++i) details[i].vehicle = detailed[i];
}

}  // namespace train_dynamics
