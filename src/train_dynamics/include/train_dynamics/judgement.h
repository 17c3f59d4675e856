#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A rule between the parts of a configuration that does not hold.
struct BrokenRule {
  std::string key, text;
  std::vector<std::string> reads;  ///< paths of what it reads besides `key`; "[]" in a path: all entries of a list
};

/// Reports the broken rules to a visitor.
template <class Visitor>
void Check(const std::vector<BrokenRule>& broken, Visitor& v) {
  for (const BrokenRule& rule : broken) {
    Keys reads;
    for (const std::string& path : rule.reads) reads.push_back(path.c_str());
    if (reads.empty()) reads.push_back(rule.key.c_str());
    v.Check(false, rule.key, rule.text, reads);
  }
}

/// A setting that is allowed but probably unintended, or outside the validated range.
struct Warning {
  std::string key;   ///< its path in the configuration
  std::string text;  ///< a sentence with numbers and remedy
};

/// "[3]", behind the key of a list.
inline std::string ListIndex(std::size_t i) { return "[" + std::to_string(i) + "]"; }

/// A number for people, to five digits.
inline std::string ShortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

}  // namespace train_dynamics
