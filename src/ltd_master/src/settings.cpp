#include "ltd_master/settings.h"

#include <fmt/format.h>

#include <cctype>
#include <cstddef>
#include <stdexcept>

namespace ltd_master {
namespace {

bool IsBlank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// The place behind a quoted text that begins at `begin`; as in YAML, '' is one ' and \" is one ".
std::size_t BehindQuotes(const std::string& text, std::size_t begin) {
  const char quote = text[begin];
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote == '"' || i + 1 >= text.size() || text[i + 1] != quote) return i + 1;
      ++i;
    }
  }
  throw std::invalid_argument(fmt::format("set: the quote {} is not closed in: {}", quote, text.substr(begin)));
}

}  // namespace

std::vector<std::string> SplitSettings(const std::string& text) {
  std::vector<std::string> settings;
  std::string open;     // brackets that are to be closed
  std::string setting;  // so far
  char last = '\0';     // character that is not a blank
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const bool begins_value = last == '=' || (!open.empty() && std::string(":,[{").find(last) != std::string::npos);
    if (open.empty() && IsBlank(c)) {
      if (!setting.empty()) settings.push_back(setting);
      setting.clear();
      last = '\0';
      ++i;
      continue;
    }
    const std::size_t end = begins_value && (c == '\'' || c == '"') ? BehindQuotes(text, i) : i + 1;
    if (end == i + 1) {
      if (c == '[' || c == '{') open += c;
      if (c == ']' || c == '}') {
        if (open.empty() || open.back() != (c == ']' ? '[' : '{'))
          throw std::invalid_argument(fmt::format("set: {} closes nothing in: {}", c, text));
        open.pop_back();
      }
    }
    setting += text.substr(i, end - i);
    if (!IsBlank(c)) last = text[end - 1];
    i = end;
  }
  if (!open.empty()) throw std::invalid_argument(fmt::format("set: {} is not closed in: {}", open.back(), text));
  if (!setting.empty()) settings.push_back(setting);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i].find('=') != std::string::npos) continue;
    const std::string hint = i == 0 ? "" : fmt::format("; a value with blanks needs quotes, as in {}", [&] {
      const std::size_t equals = settings[i - 1].find('=');
      return fmt::format("{}=\"{} {}\"", settings[i - 1].substr(0, equals), settings[i - 1].substr(equals + 1),
                         settings[i]);
    }());
    throw std::invalid_argument(fmt::format("set: {} must be a path, '=' and a value{}", settings[i], hint));
  }
  return settings;
}

}  // namespace ltd_master
