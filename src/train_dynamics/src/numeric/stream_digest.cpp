#include "train_dynamics/numeric/stream_digest.h"

namespace train_dynamics {

StreamDigest::StreamDigest() { XXH64_reset(&state_, /*seed=*/0); }

void StreamDigest::Add(const void* bytes, std::size_t size) {
  if (size == 0) return;
  XXH64_update(&state_, bytes, size);
  size_ += size;
}

std::uint64_t StreamDigest::value() const { return XXH64_digest(&state_); }

}  // namespace train_dynamics
