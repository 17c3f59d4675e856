#pragma once

#include <optional>
#include <string>

namespace strict_config {

/// Reads a finite decimal number: an optional sign, digits with an optional decimal point, an optional
/// exponent (-3, 0.5, .5, 2., 1e8, 1.5e+6). Nothing else is accepted: no nan, inf, hexadecimal or octal number (so no
/// leading zero either), no separators, no spaces, no unit. Independent of the locale.
std::optional<double> ParseNumber(const std::string& text);

/// The rule that `text` breaks by not being such a number, in words that show how to repair it.
/// @param key  whose unit the rule names
std::string NumberRule(const std::string& text, bool quoted, const std::string& key);

/// A key without its unit, and the unit in words: "initial_speed_kmh" is {"initial_speed", "km/h"}.
struct KeyUnit {
  std::string stem;
  std::string unit;  ///< empty: the key has none
};
KeyUnit SplitUnit(const std::string& key);

}  // namespace strict_config
