#include "train_sim/key_examples.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "strict_config/error_list.h"
#include "strict_config/part_library.h"
#include "strict_config/yaml_tree.h"
#include "train_dynamics/config/load_scenario.h"

namespace train_sim {
namespace {

namespace fs = std::filesystem;
using strict_config::ErrorList;
using strict_config::KeyDescription;
using strict_config::Node;
using strict_config::NodePtr;
using train_dynamics::config::FileKind;
using Examples = std::map<std::string, KeyExample>;

constexpr std::size_t kLongest = 60;  ///< letters of an example

/// A scalar or a list of scalars on one line, or nothing.
std::optional<std::string> Inline(const Node& node) {
  if (node.kind == Node::Kind::kScalar) return node.quoted ? "\"" + node.text + "\"" : node.text;
  if (node.kind != Node::Kind::kList || node.items.empty()) return std::nullopt;
  std::string text;
  for (const NodePtr& item : node.items) {
    if (item->kind != Node::Kind::kScalar) return std::nullopt;
    text += (text.empty() ? "" : ", ") + item->text;
  }
  return "[" + text + "]";
}

class Collector {
 public:
  Collector(const std::vector<FileKind>& kinds, Examples& examples) : kinds_(kinds), examples_(examples) {}

  /// @param within  parts written in place are taken too
  void TakeFile(const FileKind& kind, const fs::path& file, bool within) {
    ErrorList unread;
    strict_config::PartLibrary library({}, unread);
    file_ = kind.folder + "/" + file.filename().string();
    within_ = within;
    if (const NodePtr root = library.Open(file, "")) TakeMap(*root, kind.keys, kind.name);
  }

 private:
  void TakeMap(const Node& map, const std::vector<KeyDescription>& keys, const std::string& path) {
    for (const strict_config::Entry& entry : map.entries) {
      const auto key = std::find_if(keys.begin(), keys.end(),
                                    [&entry](const KeyDescription& k) { return k.key == entry.key; });
      if (key == keys.end()) continue;
      const std::string below = path + "." + key->key;
      if (const std::optional<std::string> text = Inline(*entry.value); text && text->size() <= kLongest)
        examples_.try_emplace(below, KeyExample{*text, file_});
      TakeBelow(*entry.value, *key, below);
    }
  }

  void TakeBelow(const Node& value, const KeyDescription& key, const std::string& path) {
    if (value.kind == Node::Kind::kList) {
      for (const NodePtr& item : value.items) TakeBelow(*item, key, path);
    } else if (value.kind == Node::Kind::kMap && !key.IsPart()) {
      TakeMap(value, key.keys, path);
    } else if (value.kind == Node::Kind::kMap && within_) {
      for (const FileKind& kind : kinds_) {
        if (kind.folder == key.folder) TakeMap(value, kind.keys, kind.name);
      }
    }
  }

  const std::vector<FileKind>& kinds_;
  Examples& examples_;
  std::string file_;
  bool within_ = false;
};

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Examples FindExamples(const std::vector<FileKind>& kinds) {
  Examples examples;
  Collector collector(kinds, examples);
  // Files of the kind itself first, then what others have written in place.
  for (const bool within : {false, true}) {
    for (const FileKind& kind : kinds) {
      for (const fs::path& root : train_dynamics::config::PartFolders()) {
        for (const fs::path& file : FilesIn(root / kind.folder)) collector.TakeFile(kind, file, within);
      }
    }
  }
  return examples;
}

}  // namespace train_sim
