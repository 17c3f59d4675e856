#pragma once

#include <cstdint>
#include <string>

#include "train_dynamics/numeric/scalar.h"

namespace train_dynamics {

/// 64-bit digest of a sequence of numbers, by their bits: equal digests mean equal bits.
class Digest {
 public:
  void Add(double value) { Add(ToBits(value)); }
  void Add(std::uint64_t value) { state_ = Mix(state_ ^ value); }
  std::uint64_t value() const { return state_; }

 private:
  /// A bijection of 64-bit words that changes about half of the bits for each bit of its argument.
  static constexpr std::uint64_t Mix(std::uint64_t x) {
    x = (x ^ (x >> 32)) * 0xd6e8feb86659fd93u;
    x = (x ^ (x >> 32)) * 0xd6e8feb86659fd93u;
    return x ^ (x >> 32);
  }
  std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// Digest of a text: its length, then its bytes, eight to a word (the first lowest), the last word padded
/// with zeros.
std::uint64_t TextDigest(const std::string& text);

}  // namespace train_dynamics
