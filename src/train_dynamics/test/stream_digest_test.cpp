#include "train_dynamics/numeric/stream_digest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace train_dynamics {
namespace {

std::uint64_t DigestOf(const std::string& text) {
  StreamDigest digest;
  digest.Add(text.data(), text.size());
  return digest.value();
}

std::string Text(std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) text.push_back(static_cast<char>(i * i + 7 * i));
  return text;
}

TEST(StreamDigest, DoesNotDependOnHowTheStreamIsCut) {
  const std::string text = Text(300);
  for (std::size_t first : {0, 1, 31, 32, 33, 64, 200}) {
    for (std::size_t second : {0, 1, 32, 63}) {
      StreamDigest digest;
      digest.Add(text.data(), first);
      digest.Add(text.data() + first, second);
      digest.Add(text.data() + first + second, text.size() - first - second);
      EXPECT_EQ(digest.value(), DigestOf(text)) << first << " " << second;
      EXPECT_EQ(digest.size(), text.size());
    }
  }
}

// Test vectors of the xxHash specification, seed 0.
TEST(StreamDigest, IsXxh64) {
  EXPECT_EQ(DigestOf(""), 0xef46db3751d8e999u);
  EXPECT_EQ(DigestOf("a"), 0xd24ec4f1a98c6e5bu);
  EXPECT_EQ(DigestOf("abc"), 0x44bc2cf5ad770999u);
}

TEST(StreamDigest, TellsEveryBitLengthAndOrder) {
  std::set<std::uint64_t> digests;
  std::size_t texts = 0;
  const auto add = [&](const std::string& text) { digests.insert(DigestOf(text)), ++texts; };
  for (std::size_t size = 0; size < 100; ++size) add(Text(size));
  for (std::size_t bit = 0; bit < 8 * 100; ++bit) {
    std::string text = Text(100);
    text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << bit % 8));
    add(text);
  }
  std::string swapped = Text(100);
  std::swap_ranges(swapped.begin(), swapped.begin() + 8, swapped.begin() + 8);
  add(swapped);
  EXPECT_EQ(digests.size(), texts);
}

}  // namespace
}  // namespace train_dynamics
