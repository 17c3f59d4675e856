#include "strict_config/writer.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <utility>

namespace strict_config {
namespace {

constexpr std::size_t kLineLength = 100;

NodePtr Scalar(std::string text, bool quoted = false) {
  auto node = std::make_shared<Node>();
  node->kind = Node::Kind::kScalar;
  node->text = std::move(text);
  node->quoted = quoted;
  return node;
}

/// Whether text reads back unchanged without quotes, also in flow style.
bool IsPlain(const std::string& text) {
  static const std::set<std::string> kSpecial{"true", "false", "yes", "no", "on", "off", "null", "y", "n"};
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto is_harmless = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' || c == '/';
  };
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), is_harmless) && kSpecial.count(lower) == 0;
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02X", static_cast<unsigned>(c));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string Flow(const Node& node) {
  std::string text;
  switch (node.kind) {
    case Node::Kind::kNull:
      return "null";
    case Node::Kind::kScalar:
      return node.quoted ? Quoted(node.text) : node.text;
    case Node::Kind::kList:
      for (const NodePtr& item : node.items) text += (text.empty() ? "" : ", ") + Flow(*item);
      return "[" + text + "]";
    case Node::Kind::kMap:
      for (const Entry& entry : node.entries)
        text += (text.empty() ? "" : ", ") + entry.key + ": " + Flow(*entry.value);
      return "{" + text + "}";
  }
  return text;
}

bool IsScalar(const NodePtr& node) { return node->kind == Node::Kind::kScalar || node->kind == Node::Kind::kNull; }

/// Whether a value is written on the line of its key.
bool IsInline(const Node& node) {
  if (node.kind == Node::Kind::kMap) return node.entries.empty();
  return std::all_of(node.items.begin(), node.items.end(), IsScalar);
}

bool IsShortMap(const Node& node, std::size_t indent) {
  return std::all_of(node.entries.begin(), node.entries.end(), [](const Entry& e) { return IsScalar(e.value); }) &&
         indent + Flow(node).size() <= kLineLength;
}

void EmitMap(const Node& map, std::size_t indent, std::string& out);

void EmitEntry(const Entry& entry, std::size_t indent, std::string& out) {
  out += entry.key + ":";
  const Node& value = *entry.value;
  if (IsInline(value)) {
    out += " " + Flow(value) + "\n";
  } else if (value.kind == Node::Kind::kMap) {
    out += "\n";
    EmitMap(value, indent + 2, out);
  } else {
    out += "\n";
    for (const NodePtr& item : value.items) {
      out += std::string(indent + 2, ' ') + "- ";
      if (IsShortMap(*item, indent + 4)) {
        out += Flow(*item) + "\n";
        continue;
      }
      for (std::size_t i = 0; i < item->entries.size(); ++i) {
        if (i > 0) out += std::string(indent + 4, ' ');
        EmitEntry(item->entries[i], indent + 4, out);
      }
    }
  }
}

void EmitMap(const Node& map, std::size_t indent, std::string& out) {
  for (const Entry& entry : map.entries) {
    out += std::string(indent, ' ');
    EmitEntry(entry, indent, out);
  }
}

}  // namespace

void Writer::Number(const char* key, double value, const Range&, const char* /*meaning*/) {
  Add(key, *Scalar(ShortestDecimal(value)));
}
void Writer::Integer(const char* key, int value, const Range&, const char* /*meaning*/) {
  Add(key, *Scalar(std::to_string(value)));
}
void Writer::Flag(const char* key, bool value, const char* /*meaning*/) { Add(key, *Scalar(value ? "true" : "false")); }
void Writer::Text(const char* key, const std::string& value, const char* /*meaning*/) {
  Add(key, *Scalar(value, !IsPlain(value)));
}

void Writer::Numbers(const char* key, const std::vector<double>& values, const Range&, const char* /*meaning*/) {
  Node list;
  list.kind = Node::Kind::kList;
  for (const double value : values) list.items.push_back(Scalar(ShortestDecimal(value)));
  Add(key, std::move(list));
}

void Writer::Integers(const char* key, const std::vector<int>& values, const Range&, const char* /*meaning*/) {
  Node list;
  list.kind = Node::Kind::kList;
  for (const int value : values) list.items.push_back(Scalar(std::to_string(value)));
  Add(key, std::move(list));
}

void Writer::Add(const char* key, Node value) {
  map_.entries.push_back({key, {}, std::make_shared<const Node>(std::move(value))});
}

std::string Emit(const Node& map) {
  if (map.entries.empty()) return "{}\n";
  std::string out;
  EmitMap(map, 0, out);
  return out;
}

}  // namespace strict_config
