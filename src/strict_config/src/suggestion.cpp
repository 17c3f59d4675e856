#include "strict_config/suggestion.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>

#include "strict_config/scalar.h"

namespace strict_config {
namespace {

constexpr std::size_t kLongestWord = 64;  ///< beyond this, a word is not worth a comparison
constexpr std::size_t kShortestRun = 3;   ///< below this, part of a word says nothing

std::string Normal(std::string word) {
  for (char& c : word) {
    c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return word;
}

/// The number of letters to insert, delete, replace or swap with their neighbour to turn a into b.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

/// How far apart two words are, or nothing if that is too far for their length to be a typing error.
std::optional<std::size_t> Distance(const std::string& a, const std::string& b) {
  const std::size_t length = std::min(a.size(), b.size());
  const std::size_t allowed = length <= 2 ? 0 : std::max<std::size_t>(1, length / 3);
  if (std::max(a.size(), b.size()) - length > allowed) return std::nullopt;
  const std::size_t distance = EditDistance(a, b);
  return distance <= allowed ? std::optional(distance) : std::nullopt;
}

/// The pieces of a key from one underscore to another: of a_b_c these are a, a_b, b, b_c, c (and not the
/// whole).
std::vector<std::string> Runs(const std::string& key) {
  std::vector<std::size_t> begins{0};
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i] == '_') begins.push_back(i + 1);
  }
  begins.push_back(key.size() + 1);
  std::vector<std::string> runs;
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    for (std::size_t j = i + 1; j < begins.size(); ++j) {
      const std::string run = key.substr(begins[i], begins[j] - begins[i] - 1);
      if (run.size() >= kShortestRun && run.size() < key.size()) runs.push_back(run);
    }
  }
  return runs;
}

}  // namespace

std::string Nearest(const std::string& written, const std::vector<std::string>& known) {
  if (written.size() > kLongestWord) return "";
  const std::string mine = Normal(written);
  const std::vector<std::string> my_runs = Runs(mine);
  std::string nearest;
  std::size_t smallest = 0;
  const auto consider = [&](const std::string& word, std::optional<std::size_t> distance, std::size_t penalty) {
    if (!distance) return;
    const std::size_t cost = 2 * *distance + penalty;
    if (!nearest.empty() && cost >= smallest) return;
    nearest = word;
    smallest = cost;
  };
  for (const std::string& word : known) {
    const std::string normal = Normal(word);
    consider(word, Distance(mine, normal), 0);
    for (const std::string& run : Runs(normal)) consider(word, Distance(mine, run), 1);
    for (const std::string& run : my_runs) consider(word, Distance(run, normal), 1);
  }
  return nearest;
}

std::string KeyHint(const std::string& written, const std::vector<std::string>& known, const std::string& noun,
                    std::size_t max_listed) {
  const std::string mine = Normal(written);
  const std::string stem = SplitUnit(mine).stem;
  const auto same = std::find_if(known.begin(), known.end(),
                                 [&](const std::string& word) { return word != mine && SplitUnit(word).stem == stem; });
  if (same != known.end()) {
    const std::string unit = SplitUnit(*same).unit;
    return "; the " + noun + " is " + *same + (unit.empty() ? ", without a unit" : ", in " + unit);
  }
  const std::string nearest = Nearest(written, known);
  if (!nearest.empty()) return "; did you mean " + nearest + "?";
  return known.empty() ? "" : "; known " + noun + "s: " + Join(known, max_listed);
}

std::string Join(const std::vector<std::string>& words, std::size_t max) {
  std::string joined;
  for (std::size_t i = 0; i < std::min(words.size(), max); ++i) {
    if (i > 0) joined += ", ";
    joined += words[i];
  }
  return words.size() > max ? joined + ", ..." : joined;
}

}  // namespace strict_config
