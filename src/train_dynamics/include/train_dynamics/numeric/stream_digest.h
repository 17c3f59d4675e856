#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace train_dynamics {

/// 64-bit digest of a stream of bytes that comes in pieces; how it is cut does not matter.
///
/// Not a Digest of its words: four chains side by side, so that it keeps up with what is written to a file.
class StreamDigest {
 public:
  void Add(const void* bytes, std::size_t size);
  std::uint64_t value() const;
  std::uint64_t size() const { return size_; }  ///< bytes so far

 private:
  static constexpr std::size_t kBlock = 32;
  void AddBlock(const std::uint8_t* block);

  std::array<std::uint64_t, 4> chains_ = {0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu,
                                          0xd6e8feb86659fd93u};
  std::array<std::uint8_t, kBlock> open_{};  ///< the block that is not full yet
  std::uint64_t size_ = 0;
};

}  // namespace train_dynamics
