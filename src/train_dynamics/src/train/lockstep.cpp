#include "train_dynamics/train/lockstep.h"

namespace train_dynamics {

VehicleRecords::VehicleRecords(int vehicles, const std::vector<int>& detailed)
    : state_digest(vehicles), details(detailed.size()) {
  ResizeRecord(vehicles, *this);
  for (size_t i = 0; i < detailed.size(); ++i) details[i].vehicle = detailed[i];
}

ExchangeReply::ExchangeReply(int vehicles, const std::vector<int>& detailed)
    : VehicleRecords(vehicles, detailed),
      energy(vehicles),
      wheelset_work_j(static_cast<std::size_t>(vehicles) * 2 * kMostWheelsets, 0.0) {
  ResizeReply(vehicles, *this);
}

}  // namespace train_dynamics
