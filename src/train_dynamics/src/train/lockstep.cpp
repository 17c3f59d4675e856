#include "train_dynamics/train/lockstep.h"

#include <algorithm>

namespace train_dynamics {

void Digest::Add(double value) { Add(ToBits(value)); }

std::uint64_t TextDigest(const std::string& text) {
  Digest digest;
  digest.Add(std::uint64_t{text.size()});
  for (std::size_t begin = 0; begin < text.size(); begin += 8) {
    std::uint64_t word = 0;
    for (std::size_t i = begin; i < std::min(begin + 8, text.size()); ++i) {
      word |= std::uint64_t{static_cast<unsigned char>(text[i])} << (8 * (i - begin));
    }
    digest.Add(word);
  }
  return digest.value();
}

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
