#include "train_dynamics/train/ranks.h"

#include <algorithm>

namespace train_dynamics {

std::vector<Rank> SplitRanks(int vehicles, int ranks) {
  const long n = vehicles, size = std::clamp(ranks, 1, vehicles);
  std::vector<Rank> split;
  for (long r = 0; r < size; ++r) {
    const int first = static_cast<int>(n * r / size), next = static_cast<int>(n * (r + 1) / size);
    split.push_back({VehicleName(first, vehicles), first, next - first, false});
  }
  return split;
}

std::vector<Rank> ExternalRanks(const TrainParams& train) {
  std::vector<Rank> ranks;
  int first = 0;
  for (const ConsistGroupParams& group : train.consist) {
    if (!group.external.empty()) ranks.push_back({group.external, first, group.count, true});
    first += group.count;
  }
  return ranks;
}

std::string VehicleName(int vehicle, int vehicles) {
  const std::string number = std::to_string(vehicle + 1);
  const std::size_t width = std::max<std::size_t>(3, std::to_string(vehicles).size());
  return "wagon_" + std::string(width - std::min(width, number.size()), '0') + number;
}

std::string VehiclesText(const Rank& rank) {
  const std::string first = std::to_string(rank.first + 1);
  return rank.count == 1 ? "vehicle " + first : "vehicles " + first + "-" + std::to_string(rank.first + rank.count);
}

}  // namespace train_dynamics
