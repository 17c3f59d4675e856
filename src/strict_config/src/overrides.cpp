#include "strict_config/overrides.h"

#include <cctype>
#include <cstddef>
#include <memory>
#include <system_error>

#include "strict_config/text_file.h"

namespace strict_config {
namespace {

/// Whether the text is keys with optional indices, joined by dots: "a.b[0][1].c".
bool IsPath(const std::string& text) {
  const auto is_key = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' || text[i] == '-');
  };
  const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  std::size_t i = 0;
  while (true) {
    if (!is_key(i)) return false;
    while (is_key(i)) ++i;
    while (i < text.size() && text[i] == '[') {
      if (!is_digit(++i)) return false;
      while (is_digit(i)) ++i;
      if (i >= text.size() || text[i++] != ']') return false;
    }
    if (i == text.size()) return true;
    if (text[i++] != '.') return false;
  }
}

}  // namespace

Overrides::Overrides(const std::vector<std::string>& arguments, const std::filesystem::path& search_from,
                     const std::string& root_name, ErrorList& errors) {
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  for (const std::string& argument : arguments) {
    const std::string label = "--set " + Printable(argument);
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || !IsPath(argument.substr(0, equals))) {
      errors.Add(label, 0, "", "must be a path, '=' and a value, as in name=mine");
      continue;
    }
    const std::string path = (root_name.empty() ? "" : root_name + ".") + argument.substr(0, equals);
    const std::string value = argument.substr(equals + 1);
    if (!IsCleanText(value, label, errors)) continue;
    const auto document = std::make_shared<const Document>(
        Document{label, here, (here / search_from).lexically_normal(), /*has_lines=*/false});
    if (const NodePtr node = ParseYaml(value, document, path, errors)) overrides_.push_back({path, node});
  }
}

NodePtr Overrides::Take(const std::string& path) {
  NodePtr value;
  for (Override& candidate : overrides_) {
    if (candidate.path != path) continue;
    value = candidate.value;
    candidate.used = true;
  }
  return value;
}

std::vector<Override*> Overrides::Below(const std::string& path) {
  std::vector<Override*> below;
  for (Override& candidate : overrides_) {
    if (candidate.used || candidate.path.size() <= path.size()) continue;
    const char next = candidate.path[path.size()];
    const bool goes_on = path.empty() || next == '.' || next == '[';
    if (goes_on && candidate.path.compare(0, path.size(), path) == 0) below.push_back(&candidate);
  }
  return below;
}

std::vector<const Override*> Overrides::Unused() const {
  std::vector<const Override*> unused;
  for (const Override& candidate : overrides_) {
    if (!candidate.used) unused.push_back(&candidate);
  }
  return unused;
}

}  // namespace strict_config
