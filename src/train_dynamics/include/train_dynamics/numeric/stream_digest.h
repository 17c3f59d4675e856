#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <cstdint>

namespace train_dynamics {

/// XXH64 of a stream of bytes that comes in pieces; how it is cut does not matter. It is what `xxhsum -H64` prints of
/// the same bytes.
class StreamDigest {
 public:
  StreamDigest();
  void Add(const void* bytes, std::size_t size);
  std::uint64_t value() const;
  std::uint64_t size() const { return size_; }  ///< bytes so far

 private:
  XXH64_state_t state_;
  std::uint64_t size_ = 0;
};

}  // namespace train_dynamics
