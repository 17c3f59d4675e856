#include "strict_config/error_list.h"

#include <algorithm>

namespace strict_config {

void ErrorList::Add(const std::string& file, int line, const KeyPath& path, const std::string& text) {
  ++reports_;
  const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
  const std::string path_in_part = path.text.substr(std::min(path.part, path.text.size()));
  if (full()) {
    ++count_;
    return;
  }
  if (!seen_.insert(place + '\n' + path_in_part + '\n' + text).second) return;
  ++count_;
  const std::size_t order = file_order_.emplace(file, file_order_.size()).first->second;
  errors_.push_back({order, line, place + ": " + path.text + (path.text.empty() ? "" : " ") + text});
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
