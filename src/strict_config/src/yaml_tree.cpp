#include "strict_config/yaml_tree.h"

#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "strict_config/scalar.h"
#include "strict_config/text_file.h"

namespace strict_config {
namespace {

/// Ends the parsing of a document that is refused as a whole.
struct Refused {
  int line;
  std::string reason;
};

/// A node with its extent after aliases are expanded.
struct Subtree {
  NodePtr node;
  std::size_t nodes = 1;
  std::size_t bytes = 0;
  std::size_t height = 0;
};

/// Builds our tree from the parser's events, so that hostile documents are refused before they grow.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::shared_ptr<const Document> document, const KeyPath& root_path, ErrorList& errors)
      : document_(std::move(document)), root_path_(root_path), errors_(errors) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    RefuseAsKey(mark);
    const auto node = NewNode(Node::Kind::kNull, mark);
    // The parser's mark is at the next token; a missing value is better reported at its key.
    if (!frames_.empty() && frames_.back().key) node->source = frames_.back().key_source;
    Place({node, 1, 0, 0}, anchor, mark);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    RefuseAsKey(mark);
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) throw Refused{Line(mark), "an alias refers to the value that it is part of"};
    Place(known->second, YAML::NullAnchor, mark);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    RefuseTag(mark, tag);
    if (!frames_.empty() && frames_.back().WantsKey()) return StartEntry(text, mark);
    const auto node = NewNode(Node::Kind::kScalar, mark);
    node->text = text;
    node->quoted = tag == "!";
    Place({node, 1, text.size(), 0}, anchor, mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    StartCollection(Node::Kind::kList, mark, tag, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    StartCollection(Node::Kind::kMap, mark, tag, anchor);
  }
  void OnSequenceEnd() override { EndCollection(); }
  void OnMapEnd() override { EndCollection(); }

 private:
  struct Frame {
    std::shared_ptr<Node> node;
    YAML::Mark mark;
    YAML::anchor_t anchor;
    Subtree extent;
    std::optional<std::string> key;  ///< of the entry whose value comes next
    Source key_source;
    bool duplicate = false;  ///< that entry is not kept
    std::unordered_map<std::string, int> key_lines;

    bool WantsKey() const { return node->kind == Node::Kind::kMap && !key; }
  };

  int Line(const YAML::Mark& mark) const { return mark.line + 1; }

  std::shared_ptr<Node> NewNode(Node::Kind kind, const YAML::Mark& mark) const {
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->source = {document_, Line(mark)};
    return node;
  }

  void RefuseAsKey(const YAML::Mark& mark, const char* reason = "a key must be plain text") const {
    if (!frames_.empty() && frames_.back().WantsKey()) throw Refused{Line(mark), reason};
  }
  void RefuseTag(const YAML::Mark& mark, const std::string& tag) const {
    // The parser's own marks: "?" for plain and "!" for quoted text.
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw Refused{Line(mark), "has the tag '" + Printable(tag) + "'; tags are not supported"};
  }

  void StartEntry(const std::string& key, const YAML::Mark& mark) {
    Frame& frame = frames_.back();
    const auto [first, is_new] = frame.key_lines.emplace(key, Line(mark));
    frame.key = key;
    frame.key_source = {document_, Line(mark)};
    frame.duplicate = !is_new;
    Count(1, key.size(), mark);
    if (is_new) return;
    frame.key_source.Report(errors_, PathOf(Printable(key)),
                            "is given twice, first in line " + std::to_string(first->second));
  }

  /// The path of a key of the innermost map.
  KeyPath PathOf(const std::string& key) const {
    std::string path = root_path_.text;
    for (std::size_t i = 0; i + 1 < frames_.size(); ++i) {
      const Frame& frame = frames_[i];
      path += frame.key ? (path.empty() ? "" : ".") + Printable(*frame.key)
                        : "[" + std::to_string(frame.node->items.size()) + "]";
    }
    return {path + (path.empty() ? "" : ".") + key, root_path_.text.size()};
  }

  void StartCollection(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    // An open bracket on the last line also comes as a key.
    RefuseAsKey(mark, "has a list or map in the place of a key (is a bracket left open?)");
    RefuseTag(mark, tag);
    RefuseDepth(frames_.size() + 1, mark);
    Count(1, 0, mark);
    Frame frame;
    frame.node = NewNode(kind, mark);
    frame.mark = mark;
    frame.anchor = anchor;
    frames_.push_back(std::move(frame));
  }

  void EndCollection() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    frame.extent.node = frame.node;
    ++frame.extent.height;
    Attach(frame.extent, frame.anchor);
  }

  void Place(const Subtree& subtree, YAML::anchor_t anchor, const YAML::Mark& mark) {
    Count(subtree.nodes, subtree.bytes, mark);
    RefuseDepth(frames_.size() + subtree.height, mark);
    Attach(subtree, anchor);
  }

  void Attach(const Subtree& subtree, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) anchors_[anchor] = subtree;
    if (frames_.empty()) {
      root_ = subtree.node;
      return;
    }
    Frame& frame = frames_.back();
    frame.extent.nodes += subtree.nodes;
    frame.extent.bytes += subtree.bytes;
    frame.extent.height = std::max(frame.extent.height, subtree.height);
    if (frame.node->kind == Node::Kind::kList) {
      frame.node->items.push_back(subtree.node);
    } else {
      if (!frame.duplicate) frame.node->entries.push_back({*frame.key, frame.key_source, subtree.node});
      frame.key.reset();
    }
  }

  void Count(std::size_t nodes, std::size_t bytes, const YAML::Mark& mark) {
    nodes_ += nodes;
    bytes_ += bytes;
    if (nodes_ > YamlLimits::kNodes) {
      throw Refused{Line(mark), "holds more than " + std::to_string(YamlLimits::kNodes) + " values"};
    }
    if (bytes_ > YamlLimits::kExpandedBytes) {
      throw Refused{Line(mark), "holds more than " + std::to_string(YamlLimits::kExpandedBytes >> 20) +
                                    " MB of text once its aliases are expanded"};
    }
  }
  void RefuseDepth(std::size_t depth, const YAML::Mark& mark) const {
    if (depth <= static_cast<std::size_t>(YamlLimits::kDepth)) return;
    throw Refused{Line(mark), "is nested deeper than " + std::to_string(YamlLimits::kDepth) + " levels"};
  }

  const std::shared_ptr<const Document> document_;
  const KeyPath root_path_;
  ErrorList& errors_;
  NodePtr root_;
  std::vector<Frame> frames_;
  std::unordered_map<YAML::anchor_t, Subtree> anchors_;
  std::size_t nodes_ = 0;
  std::size_t bytes_ = 0;
};

/// The line of the first tab in an indentation, or 0. YAML forbids it, and parsers explain it badly.
int LineWithTab(const std::string& text) {
  int line = 0;
  std::size_t begin = 0;
  while (begin < text.size()) {
    ++line;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::size_t first = std::min(text.find_first_not_of(" \t\r", begin), end);
    const bool has_content = first < end && text[first] != '#';
    if (has_content && std::string_view(text).substr(begin, first - begin).find('\t') != std::string_view::npos) {
      return line;
    }
    begin = end + 1;
  }
  return 0;
}

}  // namespace

const Entry* Node::Find(const std::string& key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

NodePtr ParseYaml(const std::string& text, const std::shared_ptr<const Document>& document, const KeyPath& root_path,
                  ErrorList& errors) {
  const auto refuse = [&](int line, const std::string& reason) {
    Source{document, line}.Report(errors, "", reason);
    return nullptr;
  };
  if (const int line = LineWithTab(text)) return refuse(line, "is indented with a tab; indent with spaces");

  TreeBuilder builder(document, root_path, errors);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    if (const NodePtr first = builder.root()) {
      TreeBuilder rest(document, root_path, errors);
      parser.HandleNextDocument(rest);
      if (rest.root()) return refuse(rest.root()->source.line, "begins a second document; a file holds one");
    }
  } catch (const YAML::Exception& error) {
    return refuse(error.mark.line + 1, "is not valid YAML: " + Printable(error.msg));
  } catch (const Refused& refused) {
    return refuse(refused.line, refused.reason);
  }

  auto root = std::make_shared<Node>(builder.root() ? *builder.root() : Node());
  root->source = {document, 1};
  return root;
}

NodePtr Merge(const NodePtr& base, const NodePtr& over) {
  const bool over_is_complete = over->kind != Node::Kind::kMap || over->under || over->Find("base");
  if (over_is_complete) return over;
  auto merged = std::make_shared<Node>(*over);
  if (base->kind == Node::Kind::kScalar) merged->under = base;
  if (base->kind != Node::Kind::kMap) return merged;

  merged->under = base->under;
  merged->entries = base->entries;
  for (const Entry& entry : over->entries) {
    const auto same = std::find_if(merged->entries.begin(), merged->entries.end(),
                                   [&](const Entry& other) { return other.key == entry.key; });
    if (same == merged->entries.end()) {
      merged->entries.push_back(entry);
    } else {
      *same = {entry.key, entry.source, Merge(same->value, entry.value)};
    }
  }
  return merged;
}

std::string Describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return "nothing";
    case Node::Kind::kList:
      return "a list";
    case Node::Kind::kMap:
      return "a map";
    case Node::Kind::kScalar:
      break;
  }
  const bool is_number = !node.quoted && ParseNumber(node.text);
  return is_number ? Printable(node.text) : "'" + Printable(node.text) + "'";
}

std::string Printable(const std::string& text) {
  constexpr std::size_t kShown = 80;
  std::size_t length = std::min(text.size(), kShown);
  // Not to cut within a character of UTF-8.
  while (length > 0 && length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0u) == 0x80u) --length;
  std::string printable;
  for (const char c : text.substr(0, length)) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    printable += is_control ? ' ' : c;
  }
  return length < text.size() ? printable + "..." : printable;
}

}  // namespace strict_config
