#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace strict_config {

/// The word among `known` that `written` was most likely meant to be, or "" when none is near.
///
/// Near is few typing errors (a letter too many, missing, wrong, or two swapped; case and hyphens do not
/// count) for the length, either in the whole or between one of them and some whole words of the other:
/// "frction" is near "friction_coefficient".
std::string Nearest(const std::string& written, const std::vector<std::string>& known);

/// The continuation of "is not a known key" with a remedy: "; did you mean ...?", "; the key is ..., in km/h" where
/// only the unit differs, or else the known keys.
/// @param noun        what the words are: "key", "column"
/// @param max_listed  the number of known words beyond which the list is cut
std::string KeyHint(const std::string& written, const std::vector<std::string>& known, const std::string& noun = "key",
                    std::size_t max_listed = 1000);

/// "a, b, c", cut after `max` words.
std::string Join(const std::vector<std::string>& words, std::size_t max);

}  // namespace strict_config
