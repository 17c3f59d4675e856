#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {

/// The chain of files that led to a node, outermost first.
using FileChain = std::vector<std::filesystem::path>;

/// Finds, reads and merges the files of which a configuration is composed.
///
/// A part is a map, or a reference to a file that holds one. A reference with a '/' or ending in .yaml or
/// .yml is a path relative to the file that contains it. Any other is a name: NAME.yaml in a folder called `kind`,
/// looked for in the folder of the referring file, in each of its ancestors, and in the search roots. A map may start
/// from another part of its kind, `base: REFERENCE`, and change what it needs. A list of maps may be a reference to a
/// file that ends in .csv: a table with a row for each of its maps.
class PartLibrary {
 public:
  /// @param remedy  the end of an error about a name if there is no folder to search: what the user can do, such as
  /// "set MY_PARTS to the folder of parts"; may be empty
  PartLibrary(std::vector<std::filesystem::path> search_roots, ErrorList& errors, std::string remedy = "");

  /// The root of a file, or null after reporting an error. A file is parsed once, however often it is used.
  NodePtr Open(const std::filesystem::path& file, const KeyPath& path);
  /// The root of a text that refers to no files, or null after reporting an error under `label`.
  NodePtr OpenText(const std::string& text, const std::string& label, const KeyPath& path);

  /// The rows of the table in the file `reference` as a list, or null after reporting an error.
  NodePtr ResolveTable(const NodePtr& reference, const KeyPath& path);

  /// The map that `node` refers to, with its references and bases resolved, or null after reporting an error.
  /// @param kind   the folder in which names are looked for
  /// @param path   of the node in the configuration, for messages
  /// @param chain  the files that must not be entered again; those that are entered are appended
  NodePtr Resolve(const NodePtr& node, const std::string& kind, const KeyPath& path, FileChain& chain);

  /// The files that were opened so far.
  std::vector<std::filesystem::path> Files() const;

  /// One sentence for each name that has different files in the searched folders: which is used, and which is not.
  /// Copies with equal content are not listed.
  const std::set<std::string>& Ambiguities() const { return ambiguities_; }

 private:
  /// Whether a reference may be followed; false after reporting an error.
  bool MayFollow(const Node& reference, const KeyPath& key);
  NodePtr Parse(const std::string& text, Document document, const KeyPath& path);
  /// @param key  the path of the reference itself: that of the part, or of its base
  NodePtr ResolveReference(const NodePtr& reference, const KeyPath& key, const std::string& kind, const KeyPath& path,
                           FileChain& chain);
  /// The file that a reference names, or an empty path after reporting an error.
  std::filesystem::path Locate(const Node& reference, const KeyPath& key, const std::string& kind);
  std::filesystem::path LocateName(const Node& reference, const KeyPath& key, const std::string& kind);
  void NoteAmbiguity(const std::filesystem::path& used, const std::filesystem::path& other);

  std::vector<std::filesystem::path> search_roots_;
  ErrorList& errors_;
  std::string remedy_;
  std::map<std::filesystem::path, NodePtr> files_;
  std::map<NodePtr, std::filesystem::path> located_;  ///< the file of each reference
  std::set<std::string> ambiguities_;
};

/// Whether a value is a reference to a table.
bool IsTableReference(const Node& value);

/// The folders listed in an environment variable, separated by ':'.
std::vector<std::filesystem::path> FoldersInEnvironment(const char* variable);

}  // namespace strict_config
