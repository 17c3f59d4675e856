#include "strict_config/error_list.h"

#include <algorithm>

namespace strict_config {
namespace {

/// Whether a path leads to `other` or to something below it.
bool LeadsTo(const std::string& path, const std::string& other) {
  if (other.compare(0, path.size(), path) != 0) return false;
  return path.empty() || other.size() == path.size() || other[path.size()] == '.' || other[path.size()] == '[';
}

/// A path with every index left out, "consist[2].vehicle" as "consist[].vehicle".
std::string WithoutIndices(const std::string& path) {
  std::string text;
  bool in_index = false;
  for (char c : path) {
    if (c == ']') in_index = false;
    if (!in_index) text += c;
    if (c == '[') in_index = true;
  }
  return text;
}

}  // namespace

void ErrorList::Add(const std::string& file, int line, const KeyPath& path, const std::string& text) {
  ++reports_;
  const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
  const std::string path_in_part = path.text.substr(std::min(path.part, path.text.size()));
  if (full()) {
    ++count_;
    return;
  }
  paths_.insert(path.text);
  if (!seen_.insert(place + '\n' + path_in_part + '\n' + text).second) return;
  ++count_;
  const std::size_t order = file_order_.emplace(file, file_order_.size()).first->second;
  errors_.push_back({order, line, place + ": " + path.text + (path.text.empty() ? "" : " ") + text});
}

bool ErrorList::Concerns(const std::string& path, const std::function<bool(const std::string&)>& is_read) const {
  if (full()) return true;
  const std::size_t any = path.find("[]");
  const auto is_below_or_above = [&](const std::string& reported) {
    const std::string at = any == std::string::npos ? reported : WithoutIndices(reported);
    return LeadsTo(path, at) || (LeadsTo(at, path) && !is_read(reported));
  };
  // What begins like the path up to its first index that is open; then what is above that.
  const std::string begin = path.substr(0, any);
  for (auto at = paths_.lower_bound(begin); at != paths_.end() && at->compare(0, begin.size(), begin) == 0; ++at) {
    if (is_below_or_above(*at)) return true;
  }
  for (std::size_t end = begin.find_last_of(".["); end != std::string::npos && end > 0;
       end = begin.find_last_of(".[", end - 1)) {
    const auto above = paths_.find(begin.substr(0, end));
    if (above != paths_.end() && !is_read(*above)) return true;
  }
  return false;
}

std::string ErrorList::Text(std::size_t shown) const {
  std::vector<const Error*> ordered;
  for (const Error& error : errors_) ordered.push_back(&error);
  std::stable_sort(ordered.begin(), ordered.end(), [](const Error* a, const Error* b) {
    return a->file_order != b->file_order ? a->file_order < b->file_order : a->line < b->line;
  });
  shown = std::min(shown, ordered.size());
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : "\n") + ordered[i]->text;
  if (count_ > shown) text += "\nand " + std::to_string(count_ - shown) + " more";
  return text;
}

}  // namespace strict_config
