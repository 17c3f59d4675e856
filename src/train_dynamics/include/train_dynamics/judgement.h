#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A rule between the parts of a configuration that does not hold, as a visitor's Check takes it.
struct BrokenRule {
  std::string key, text;
  Keys reads;
};

/// Something that is allowed but most likely not meant, or beyond what was shown to work.
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
