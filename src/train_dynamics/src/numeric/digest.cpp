#include "train_dynamics/numeric/digest.h"

#include <algorithm>

namespace train_dynamics {

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

}  // namespace train_dynamics
