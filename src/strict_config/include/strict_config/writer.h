#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "strict_config/parameters.h"
#include "strict_config/validate.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {

/// The visitor that turns a struct into a map of YAML, keys in visit order.
class Writer {
 public:
  void Number(const char* key, double value, const Range&, const char* /*meaning*/);
  void Number(const char* key, const std::optional<double>& value, const Range& range, const char* /*meaning*/) {
    if (value) Number(key, *value, range, nullptr);
  }
  void Integer(const char* key, int value, const Range&, const char* /*meaning*/);
  void Flag(const char* key, bool value, const char* /*meaning*/);
  void Text(const char* key, const std::string& value, const char* /*meaning*/);
  void Numbers(const char* key, const std::vector<double>& values, const Range&, const char* /*meaning*/);
  void Integers(const char* key, const std::vector<int>& values, const Range&, const char* /*meaning*/);
  void Check(bool, const std::string&, const std::string&, const Keys& = {}) {}

  template <class Enum>
  void Choice(const char* key, Enum value, Choices<Enum> choices, const char* /*meaning*/) {
    for (const auto& choice : choices) {
      if (choice.second == value) return Text(key, choice.first, nullptr);
    }
  }
  template <class Enum>
  void Choice(const char* key, std::optional<Enum> value, Choices<Enum> choices, const char* /*meaning*/) {
    if (value) Choice(key, *value, choices, nullptr);
  }

  template <class Struct>
  void Group(const char* key, Struct& value, const char* /*meaning*/) {
    Add(key, MapOf(value));
  }
  template <class Struct>
  void Group(const char* key, std::optional<Struct>& value, const char* /*meaning*/) {
    Add(key, value ? MapOf(*value) : Node());
  }
  template <class Value>
  void Part(const char* key, Value& value, const char* /*kind*/, const char* /*meaning*/) {
    Group(key, value, nullptr);
  }
  template <class Struct>
  void List(const char* key, std::vector<Struct>& values, const char* /*meaning*/) {
    Node list;
    list.kind = Node::Kind::kList;
    for (Struct& value : values) list.items.push_back(std::make_shared<const Node>(MapOf(value)));
    Add(key, std::move(list));
  }
  template <class Struct>
  void Parts(const char* key, std::vector<Struct>& values, const char* /*kind*/, const char* /*meaning*/) {
    List(key, values, nullptr);
  }

  template <class Struct>
  static Node MapOf(Struct& value) {
    Writer writer;
    value.Visit(writer);
    return std::move(writer.map_);
  }

 private:
  Writer() { map_.kind = Node::Kind::kMap; }
  void Add(const char* key, Node value);

  Node map_;
};

/// The text of a tree: maps in block style; lists of scalars, and short maps in lists, in flow style.
std::string Emit(const Node& map);

/// A parameter struct as YAML text that reads back to the same bits: all parts in place, nothing left to
/// defaults.
///
/// @throws std::invalid_argument if the struct breaks its own rules (the text would not be readable)
template <class Struct>
std::string Write(const Struct& value) {
  Validate(value);
  Struct copy = value;  // Visit is not const, because the reader writes through it.
  return Emit(Writer::MapOf(copy));
}

}  // namespace strict_config
