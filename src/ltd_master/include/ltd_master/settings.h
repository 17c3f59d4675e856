#pragma once

#include <string>
#include <vector>

namespace ltd_master {

/// The settings path=value in one text, as the launch argument `set` has them, separated by blanks.
///
/// A blank within quotes, [lists] or {maps} belongs to the value, which is YAML:
///
///   duration_s=2 description="two words" commands=[{time_s: 2, kind: apply, reduction_kpa: 80}]
///
/// A quote begins a quoted text where a value begins (behind '=', ':', ',', '[' or '{'), as in YAML; elsewhere it is an
/// apostrophe.
/// @throws std::invalid_argument for a quote or bracket that is not closed, and for a word that is no setting, such as
/// the second word of a value without quotes
std::vector<std::string> SplitSettings(const std::string& text);

}  // namespace ltd_master
