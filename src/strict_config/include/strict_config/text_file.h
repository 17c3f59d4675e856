#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "strict_config/error_list.h"

namespace strict_config {

/// The path as messages show it: relative to the working directory where the file is below it, else absolute.
std::string DisplayPath(const std::filesystem::path& path);

/// Reads a whole text file that may be hostile.
///
/// Refused, with an error that says which: a missing or unreadable file, a directory or device, more than
/// `max_bytes`, NUL and other control characters, text that is not UTF-8.
std::optional<std::string> ReadTextFile(const std::filesystem::path& path, std::size_t max_bytes, ErrorList& errors);

/// Checks text that did not come from a file: no control characters, valid UTF-8. Reports under `label`.
bool IsCleanText(const std::string& text, const std::string& label, ErrorList& errors);

}  // namespace strict_config
