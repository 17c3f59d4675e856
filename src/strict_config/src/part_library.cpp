#include "strict_config/part_library.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "strict_config/csv_table.h"
#include "strict_config/suggestion.h"
#include "strict_config/text_file.h"

namespace strict_config {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxChain = 64;  ///< longest chain of files that lead to a value
constexpr std::size_t kListedNames = 12;
constexpr const char* kExtension = ".yaml";

bool IsFileReference(const std::string& text) {
  const std::string extension = fs::path(text).extension().string();
  return text.find('/') != std::string::npos || extension == ".yaml" || extension == ".yml";
}

bool IsName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  });
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// The path that identifies a file. Links are not followed, so that references in a linked file are found beside the
/// link, and messages name files as the user does.
fs::path Normal(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return (error ? path : absolute).lexically_normal();
}

/// The names of the parts in a folder, sorted.
std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
    if (file->path().extension() == kExtension) names.push_back(file->path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

NodePtr WithoutBase(const NodePtr& map) {
  auto rest = std::make_shared<Node>(*map);
  rest->under = nullptr;
  const auto is_base = [](const Entry& entry) { return entry.key == "base"; };
  rest->entries.erase(std::remove_if(rest->entries.begin(), rest->entries.end(), is_base), rest->entries.end());
  return rest;
}

}  // namespace

PartLibrary::PartLibrary(std::vector<fs::path> search_roots, ErrorList& errors, std::string remedy)
    : search_roots_(std::move(search_roots)), errors_(errors), remedy_(std::move(remedy)) {}

NodePtr PartLibrary::Open(const fs::path& file, const KeyPath& path) {
  const auto [cached, is_new] = files_.try_emplace(Normal(file));
  if (!is_new) return cached->second;
  const std::optional<std::string> text = ReadTextFile(file, YamlLimits::kBytes, errors_);
  if (!text) return nullptr;
  const fs::path folder = Normal(file).parent_path();
  return cached->second = Parse(*text, {DisplayPath(file), folder, folder}, path);
}

std::vector<fs::path> PartLibrary::Files() const {
  std::vector<fs::path> files;
  for (const auto& [file, root] : files_) files.push_back(file);
  return files;
}

NodePtr PartLibrary::OpenText(const std::string& text, const std::string& label, const KeyPath& path) {
  if (text.size() > YamlLimits::kBytes) {
    errors_.Add(label, 0, path,
                "has " + std::to_string(text.size()) + " bytes; the limit is " + std::to_string(YamlLimits::kBytes));
    return nullptr;
  }
  if (!IsCleanText(text, label, errors_)) return nullptr;
  return Parse(text, {label, {}, {}, true, true}, path);
}

NodePtr PartLibrary::Parse(const std::string& text, Document document, const KeyPath& path) {
  NodePtr root = ParseYaml(text, std::make_shared<const Document>(std::move(document)), path, errors_);
  if (!root || root->kind == Node::Kind::kMap) return root;
  root->source.Report(errors_, "", "must hold a map of keys and values, got " + Describe(*root));
  return nullptr;
}

NodePtr PartLibrary::Resolve(const NodePtr& node, const std::string& kind, const KeyPath& path, FileChain& chain) {
  if (node->kind == Node::Kind::kScalar) return ResolveReference(node, path, kind, path, chain);
  if (node->kind != Node::Kind::kMap) {
    node->source.Report(errors_, path, "must be a map, a file, or a name from " + kind + "/, got " + Describe(*node));
    return nullptr;
  }
  const Entry* const base = node->Find("base");
  if (!base && !node->under) return node;
  const KeyPath base_path = base ? KeyPath(path.text.empty() ? "base" : path.text + ".base", path.part) : path;
  const NodePtr reference = base ? base->value : node->under;
  if (reference->kind != Node::Kind::kScalar) {
    base->source.Report(errors_, base_path,
                        "must be a file, or a name from " + kind + "/, got " + Describe(*reference));
    return nullptr;
  }
  const NodePtr below = ResolveReference(reference, base_path, kind, path, chain);
  return below ? Merge(below, WithoutBase(node)) : nullptr;
}

bool PartLibrary::MayFollow(const Node& reference, const KeyPath& key) {
  if (!reference.source.document->stands_alone) return true;
  reference.source.Report(errors_, key, "must be a map, because no files are read here, got " + Describe(reference));
  return false;
}

NodePtr PartLibrary::ResolveTable(const NodePtr& reference, const KeyPath& path) {
  if (!MayFollow(*reference, path)) return nullptr;
  const fs::path file = Normal(reference->source.document->folder / reference->text);
  if (!Exists(file)) {
    reference->source.Report(errors_, path,
                             "names the file " + Describe(*reference) + ", but there is no " + DisplayPath(file));
    return nullptr;
  }
  const auto [cached, is_new] = files_.try_emplace(file);
  if (!is_new) return cached->second;
  const fs::path folder = file.parent_path();
  const auto document = std::make_shared<const Document>(Document{DisplayPath(file), folder, folder});
  return cached->second = ReadCsvList(file.string(), document, errors_);
}

NodePtr PartLibrary::ResolveReference(const NodePtr& reference, const KeyPath& key, const std::string& kind,
                                      const KeyPath& path, FileChain& chain) {
  if (!MayFollow(*reference, key)) return nullptr;
  const auto [located, is_new] = located_.try_emplace(reference);
  if (is_new) located->second = Locate(*reference, key, kind);
  const fs::path& file = located->second;
  if (file.empty()) return nullptr;

  const auto refuse = [&](const std::string& reason) {
    reference->source.Report(errors_, key, reason);
    return nullptr;
  };
  const auto again = std::find(chain.begin(), chain.end(), file);
  if (again != chain.end()) {
    std::string cycle;
    for (auto entered = again; entered != chain.end(); ++entered) cycle += DisplayPath(*entered) + " -> ";
    return refuse("includes a file in itself: " + cycle + DisplayPath(file));
  }
  if (chain.size() >= kMaxChain) {
    return refuse("refers to a file that is reached through more than " + std::to_string(kMaxChain) + " others");
  }
  chain.push_back(file);
  const NodePtr root = Open(file, path);
  return root ? Resolve(root, kind, {path.text, path.text.size()}, chain) : nullptr;
}

fs::path PartLibrary::Locate(const Node& reference, const KeyPath& key, const std::string& kind) {
  const auto refuse = [&](const std::string& reason) {
    reference.source.Report(errors_, key, reason);
    return fs::path();
  };
  if (IsFileReference(reference.text)) {
    fs::path file = Normal(reference.source.document->folder / reference.text);
    if (Exists(file)) return file;
    return refuse("names the file " + Describe(reference) + ", but there is no " + DisplayPath(file));
  }
  if (IsName(reference.text)) return LocateName(reference, key, kind);
  return refuse("must be a map, a file, or a name from " + kind + "/, got " + Describe(reference));
}

fs::path PartLibrary::LocateName(const Node& reference, const KeyPath& key, const std::string& kind) {
  std::vector<fs::path> roots;
  for (fs::path folder = reference.source.document->search_from; !folder.empty(); folder = folder.parent_path()) {
    roots.push_back(folder);
    if (folder == folder.parent_path()) break;
  }
  roots.insert(roots.end(), search_roots_.begin(), search_roots_.end());

  fs::path found;
  std::vector<std::string> searched;
  std::vector<std::string> names;
  for (const fs::path& root : roots) {
    const fs::path folder = root / kind;
    if (!IsFolder(folder)) continue;
    const fs::path file = folder / (reference.text + kExtension);
    if (!found.empty()) {
      NoteAmbiguity(found, file);
      continue;
    }
    if (Exists(file)) {
      found = Normal(file);
      continue;
    }
    searched.push_back(DisplayPath(folder));
    for (const std::string& name : NamesIn(folder)) names.push_back(name);
  }

  if (!found.empty()) return found;

  std::string text = "names " + Describe(reference);
  if (searched.empty()) {
    text += ", but there is no folder " + kind + " in " + DisplayPath(reference.source.document->search_from) +
            " or above it";
    for (const fs::path& root : search_roots_) text += ", nor in " + DisplayPath(root);
    text += "; or give a file";
    if (!remedy_.empty()) text += ", or " + remedy_;
  } else {
    text += ", but there is no " + reference.text + kExtension + " in " + Join(searched, searched.size());
    const std::string nearest = Nearest(reference.text, names);
    if (!nearest.empty()) text += "; did you mean " + nearest + "?";
    if (!names.empty() && names.size() <= kListedNames) text += " (there: " + Join(names, kListedNames) + ")";
  }
  reference.source.Report(errors_, key, text);
  return {};
}

void PartLibrary::NoteAmbiguity(const fs::path& used, const fs::path& other) {
  std::error_code error;
  if (!Exists(other) || fs::equivalent(used, other, error)) return;
  ErrorList unread;
  const std::optional<std::string> ours = ReadTextFile(used, YamlLimits::kBytes, unread);
  const std::optional<std::string> theirs = ReadTextFile(other, YamlLimits::kBytes, unread);
  if (ours && theirs && *ours == *theirs) return;
  ambiguities_.insert(DisplayPath(used) + " is used; " + DisplayPath(Normal(other)) +
                      " has the same name, another content, and is not");
}

bool IsTableReference(const Node& value) {
  return value.kind == Node::Kind::kScalar && fs::path(value.text).extension() == ".csv";
}

std::vector<fs::path> FoldersInEnvironment(const char* variable) {
  std::vector<fs::path> roots;
  const char* const value = std::getenv(variable);
  std::istringstream list(value ? value : "");
  for (std::string root; std::getline(list, root, ':');) {
    if (!root.empty()) roots.emplace_back(root);
  }
  return roots;
}

}  // namespace strict_config
