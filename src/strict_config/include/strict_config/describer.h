#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "strict_config/parameters.h"

/// The keys of a parameter struct, from its Visit list: the source of references and schemas.
namespace strict_config {

/// When a key is known, or must be given: another key of the same map has one of these values.
///
/// Values are words of a choice, `true` or `false`, `given` or `not given` (of a number without a default), `> 1` (of a
/// whole number).
struct KeyCondition {
  std::string key;
  std::vector<std::string> values;

  /// "kind direct_release or graduated_release", "mass_kg given"
  std::string Text() const;
};

struct KeyDescription {
  enum class Kind { kNumber, kInteger, kFlag, kText, kChoice, kNumbers, kIntegers, kGroup, kList, kPart, kParts };

  std::string key;
  const void* type = nullptr;  ///< differs if one key has different structs, depending on the value of another key
  Kind kind = Kind::kNumber;
  std::string meaning;
  Range range{};                        ///< of numbers
  std::vector<std::string> choices;     ///< the words of a choice
  std::string default_value;            ///< as YAML; empty: there is none
  bool may_be_left_out = true;          ///< it has a default, or its absence has a meaning
  bool is_required_by_default = false;  ///< it must be given where all other keys are left out
  std::string folder;                   ///< of a part: where its files are looked for
  bool may_be_table = false;            ///< it may be a CSV file
  std::vector<KeyDescription> keys;     ///< of a group or part, or of each entry of a list of them

  std::vector<KeyCondition> known_with;  ///< all must hold; none: always
  /// It must be given where all hold; none: where it is known, always or never.
  std::vector<KeyCondition> required_with;

  bool IsSame(const KeyDescription& other) const { return key == other.key && type == other.type; }
  bool IsMap() const { return kind == Kind::kGroup || kind == Kind::kPart; }
  bool IsListOfMaps() const { return kind == Kind::kList || kind == Kind::kParts; }
  bool IsPart() const { return kind == Kind::kPart || kind == Kind::kParts; }
};

/// The visitor that collects what is called in one visit. Which keys are called depends on the values of others (`if
/// (kind == ...)`): DescribeKeys visits once for each value of each of these.
class Describer {
 public:
  /// A key on whose value the list may depend, and its possible values, except the present one.
  struct Selector {
    std::string key;
    std::string value;
    std::vector<std::string> others;
  };

  /// @param known  keys that were described before: maps below them are not visited again
  /// @param set    a selector and its value for this visit; empty: values stay
  Describer(const std::vector<KeyDescription>& known, std::pair<std::string, std::string> set)
      : known_(known), set_(std::move(set)) {}

  void Number(const char* key, double& value, const Range& range, const char* meaning);
  void Number(const char* key, std::optional<double>& value, const Range& range, const char* meaning);
  void Integer(const char* key, int& value, const Range& range, const char* meaning);
  void Flag(const char* key, bool& value, const char* meaning);
  void Text(const char* key, const std::string& value, const char* meaning);
  void Numbers(const char* key, const std::vector<double>& values, const Range& range, const char* meaning);
  void Integers(const char* key, const std::vector<int>& values, const Range& range, const char* meaning);
  void Check(bool, const std::string&, const std::string&, const Keys& = {}) {}

  template <class Enum>
  void Choice(const char* key, Enum& value, Choices<Enum> choices, const char* meaning) {
    std::optional<Enum> chosen = value;
    Choice(key, chosen, choices, meaning);
    value = *chosen;
  }
  template <class Enum>
  void Choice(const char* key, std::optional<Enum>& value, Choices<Enum> choices, const char* meaning) {
    KeyDescription& described = Add(key, KeyDescription::Kind::kChoice, meaning);
    Selector selector{key, "", {}};
    for (const auto& [word, stands_for] : choices) {
      described.choices.push_back(word);
      const bool is_value = value && *value == stands_for;
      if (is_value) described.default_value = word;
      if (is_value && selector.value.empty()) {
        selector.value = word;
      } else {
        selector.others.push_back(word);
      }
    }
    if (value) selectors_.push_back(selector);
    if (set_.first != key) return;
    for (const auto& [word, stands_for] : choices) {
      if (set_.second == word) value = stands_for;
    }
  }

  template <class Struct>
  void Group(const char* key, Struct& value, const char* meaning) {
    AddMap(key, KeyDescription::Kind::kGroup, "", value, meaning);
  }
  template <class Struct>
  void Group(const char* key, std::optional<Struct>& value, const char* meaning) {
    AddMap(key, KeyDescription::Kind::kGroup, "", value, meaning);
  }
  template <class Value>
  void Part(const char* key, Value& value, const char* folder, const char* meaning) {
    AddMap(key, KeyDescription::Kind::kPart, folder, value, meaning);
  }
  template <class Struct>
  void List(const char* key, const std::vector<Struct>& values, const char* meaning) {
    AddList(key, KeyDescription::Kind::kList, "", values, meaning);
  }
  template <class Struct>
  void Parts(const char* key, const std::vector<Struct>& values, const char* folder, const char* meaning) {
    AddList(key, KeyDescription::Kind::kParts, folder, values, meaning);
  }

  const std::vector<KeyDescription>& keys() const { return keys_; }
  const std::vector<Selector>& selectors() const { return selectors_; }

 private:
  KeyDescription& Add(const char* key, KeyDescription::Kind kind, const char* meaning);
  /// What an earlier visit has described under the key of a struct, or null.
  const KeyDescription* Known(const KeyDescription& described) const;

  template <class Struct>
  void AddMap(const char* key, KeyDescription::Kind kind, const char* folder, const Struct& value, const char* meaning);
  template <class Struct>
  void AddMap(const char* key, KeyDescription::Kind kind, const char* folder, const std::optional<Struct>& value,
              const char* meaning);
  template <class Struct>
  void AddList(const char* key, KeyDescription::Kind kind, const char* folder, const std::vector<Struct>& values,
               const char* meaning);

  const std::vector<KeyDescription>& known_;
  const std::pair<std::string, std::string> set_;
  std::vector<KeyDescription> keys_;
  std::vector<Selector> selectors_;
};

/// The keys called by visits with one selector changed at a time.
class KeyCollection {
 public:
  /// @param set  the selector that was changed, and its value; empty: none
  void Take(const Describer& visit, const std::pair<std::string, std::string>& set);
  const std::vector<KeyDescription>& keys() const { return keys_; }
  /// All keys, with their conditions.
  std::vector<KeyDescription> Finish() const;

 private:
  struct Visit {
    std::pair<std::string, std::string> set;
    std::vector<std::pair<KeyDescription, bool>> called;  ///< keys, and whether they had to be given
  };

  std::vector<KeyDescription> keys_;
  std::vector<Describer::Selector> selectors_;  ///< of the first visit
  std::vector<Visit> visits_;
};

/// The keys of a struct, in the order of its Visit list, with those that are known only for some values of others.
///
/// A key that is called only where two others have certain values is not found.
/// @param prototype  its values are the defaults
template <class Struct>
std::vector<KeyDescription> DescribeKeys(const Struct& prototype = Struct()) {
  KeyCollection collection;
  const auto visit = [&](const std::pair<std::string, std::string>& set) {
    Struct value = prototype;
    Describer describer(collection.keys(), set);
    value.Visit(describer);
    collection.Take(describer, set);
    return describer.selectors();
  };
  for (const Describer::Selector& selector : visit({})) {
    for (const std::string& other : selector.others) visit({selector.key, other});
  }
  return collection.Finish();
}

/// Whether a part of this struct may be a table; see Reader::TableKey.
template <class Struct, class = void>
struct MayBeTable : std::false_type {};
template <class Struct>
struct MayBeTable<Struct, std::void_t<decltype(Struct::kTableKey)>> : std::true_type {};

/// Stands for a struct.
template <class Struct>
inline constexpr char kTypeTag = 0;

template <class Struct>
void Describer::AddMap(const char* key, KeyDescription::Kind kind, const char* folder, const Struct& value,
                       const char* meaning) {
  KeyDescription& described = Add(key, kind, meaning);
  described.type = &kTypeTag<Struct>;
  described.folder = folder;
  described.may_be_table = kind == KeyDescription::Kind::kPart && MayBeTable<Struct>::value;
  if (const KeyDescription* const known = Known(described)) {
    described.may_be_left_out = known->may_be_left_out;
    return;
  }
  described.keys = DescribeKeys(value);
  described.may_be_left_out = std::none_of(described.keys.begin(), described.keys.end(),
                                           [](const KeyDescription& k) { return k.is_required_by_default; });
}

template <class Struct>
void Describer::AddMap(const char* key, KeyDescription::Kind kind, const char* folder,
                       const std::optional<Struct>& value, const char* meaning) {
  AddMap(key, kind, folder, value ? *value : Struct(), meaning);
  keys_.back().may_be_left_out = true;
}

template <class Struct>
void Describer::AddList(const char* key, KeyDescription::Kind kind, const char* folder,
                        const std::vector<Struct>& values, const char* meaning) {
  KeyDescription& described = Add(key, kind, meaning);
  described.type = &kTypeTag<Struct>;
  described.folder = folder;
  described.may_be_table = true;
  described.default_value = values.empty() ? "[]" : "[{}]";
  if (Known(described) == nullptr) described.keys = DescribeKeys(Struct());
}

}  // namespace strict_config
