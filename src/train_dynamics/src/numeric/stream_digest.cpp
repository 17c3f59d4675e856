#include "train_dynamics/numeric/stream_digest.h"

#include <algorithm>
#include <cstring>

#include "train_dynamics/numeric/digest.h"

namespace train_dynamics {

void StreamDigest::AddBlock(const std::uint8_t* block) {
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, block + i * sizeof word, sizeof word);
    chains_[i] = (chains_[i] ^ word) * 0xd6e8feb86659fd93u;  // odd: no word gets lost
    chains_[i] ^= chains_[i] >> 32;
  }
}

void StreamDigest::Add(const void* bytes, std::size_t size) {
  const auto* from = static_cast<const std::uint8_t*>(bytes);
  std::size_t open = size_ % kBlock;
  size_ += size;
  if (open > 0) {
    const std::size_t count = std::min(size, kBlock - open);
    std::copy_n(from, count, open_.begin() + static_cast<std::ptrdiff_t>(open));
    from += count, size -= count, open += count;
    if (open < kBlock) return;
    AddBlock(open_.data());
  }
  for (; size >= kBlock; from += kBlock, size -= kBlock) AddBlock(from);
  std::copy_n(from, size, open_.begin());
}

std::uint64_t StreamDigest::value() const {
  Digest digest;
  digest.Add(size_);
  for (const std::uint64_t chain : chains_) digest.Add(chain);
  for (std::size_t i = 0; i < size_ % kBlock; ++i) digest.Add(std::uint64_t{open_[i]});
  return digest.value();
}

}  // namespace train_dynamics
