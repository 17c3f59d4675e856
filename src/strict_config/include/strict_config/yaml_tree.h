#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "strict_config/error_list.h"

/// A YAML document as a tree in which every node knows where it was written, even after documents were
/// merged.
namespace strict_config {

/// Where text came from: a file, or an override of the command line.
struct Document {
  std::string label;                  ///< what messages name: "config/scenarios/dip.yaml", "--set dt_s=1e-4"
  std::filesystem::path folder;       ///< files that it refers to are relative to this
  std::filesystem::path search_from;  ///< names that it refers to are looked for from here upwards
  bool has_lines = true;              ///< false: messages name no line
  bool stands_alone = false;          ///< it may not refer to files or names
};

/// A place in a document.
struct Source {
  std::shared_ptr<const Document> document;
  int line = 0;  ///< counted from 1; 0: the whole document

  void Report(ErrorList& errors, const KeyPath& path, const std::string& text) const {
    errors.Add(document->label, document->has_lines ? line : 0, path, text);
  }
};

struct Node;
/// Shared, because aliases, repeated references and merged documents have subtrees in common.
using NodePtr = std::shared_ptr<const Node>;

/// A key and its value in a map.
struct Entry {
  std::string key;
  Source source;  ///< of the key
  NodePtr value;
};

/// A value of a document; constant once it is built.
struct Node {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  Source source;
  std::string text;            ///< of a scalar
  bool quoted = false;         ///< the scalar was written in quotes or as a block, so it is no number
  std::vector<NodePtr> items;  ///< of a list
  std::vector<Entry> entries;  ///< of a map, in the order written
  bool is_row = false;         ///< a map that is a row of a table: its keys are those of the rows beside it
  NodePtr under;               ///< what a map replaced in a merge, when that was a scalar: see Merge

  /// The entry of a map, or null.
  const Entry* Find(const std::string& key) const;
};

/// The bounds within which any text is parsed, however hostile.
struct YamlLimits {
  static constexpr std::size_t kBytes = 64u << 20;          ///< of a file
  static constexpr int kDepth = 64;                         ///< of nested lists and maps
  static constexpr std::size_t kNodes = 3000000;            ///< after aliases are expanded
  static constexpr std::size_t kExpandedBytes = 64u << 20;  ///< of all scalars after aliases are expanded
};

/// Parses one YAML document.
///
/// Accepted is the YAML 1.2 that a configuration needs: anchors and aliases yes; tags, several documents in a
/// file, keys that are not plain text, and tabs in the indentation no. Keys that are given twice are reported
/// and the first one kept.
///
/// @param root_path  the path of the document's root in the configuration, for messages
/// @return null after an error that leaves nothing to read
NodePtr ParseYaml(const std::string& text, const std::shared_ptr<const Document>& document, const KeyPath& root_path,
                  ErrorList& errors);

/// `over` on top of `base`, both maps: maps are merged key by key; lists and scalars replace.
///
/// Where a map replaces a scalar, the scalar stays known as `under`: if the key turns out to be a part, the
/// scalar is the name of what the map modifies. A map with a `base` of its own replaces as well.
NodePtr Merge(const NodePtr& base, const NodePtr& over);

/// "a list", "a map", "nothing", -0.4, 'text': a value as messages show it after "got".
std::string Describe(const Node& node);
/// Text from a user as messages show it: on one line, printable, not too long.
std::string Printable(const std::string& text);

}  // namespace strict_config
