#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/overrides.h"
#include "strict_config/parameters.h"
#include "strict_config/part_library.h"
#include "strict_config/yaml_tree.h"

/// Strict reading of YAML into parameter structs; see parameters.h for how a struct lists its fields.
///
///     ErrorList errors;
///     const auto scenario = Load<ScenarioConfig>("config/scenarios/dip.yaml", options, errors);
///     if (!errors.empty()) { std::cerr << errors.Text(); return 2; }
namespace strict_config {

struct LoadOptions {
  /// Folders in which parts are looked for after the file's own folder and its ancestors.
  std::vector<std::filesystem::path> search_roots;
  /// What the user can do if there is no folder to search; see PartLibrary.
  std::string search_remedy;
  /// Values that replace those of the files: "train.coupler.slack_m=0.01".
  std::vector<std::string> overrides;
  /// What the paths in messages start with ("scenario" gives scenario.dt_s); not part of override paths.
  std::string root_name;
  /// The folder in which a `base: NAME` of the file itself is looked for; empty: the folder that the file is
  /// in.
  std::string kind;
  /// The sizes that a number can have in reality, by the path of its key, beyond what its range allows: beyond them the
  /// reader of a file asks whether the unit is right. Zero is not judged. Empty: any size is accepted.
  std::function<Range(const std::string& path)> plausible_size;
};

/// The state that all readers of one configuration share.
struct ReadSession {
  /// The largest number of values of a configuration, references expanded.
  static constexpr std::size_t kMaxValues = 3000000;
  /// The largest length of a list of maps or parts.
  static constexpr std::size_t kMaxItems = 200000;

  ErrorList& errors;
  PartLibrary library;
  Overrides overrides;
  std::size_t values_left = kMaxValues;

  /// A map that a struct was read from.
  struct ReadMap {
    NodePtr map;  ///< null: an empty map
    Source source;
    std::size_t part = 0;  ///< see KeyPath
  };
  std::map<std::string, ReadMap> read = {};                                ///< by path
  std::function<Range(const std::string& path)> plausible_size = nullptr;  ///< see LoadOptions

  /// A place in the configuration, with its value.
  struct Spot {
    Source source;
    NodePtr value;  ///< null: not given
    KeyPath path;
  };
  Spot Locate(const std::string& path);
};

/// The visitor that fills a struct from one map of a document.
class Reader {
 public:
  void Number(const char* key, double& value, const Range& range, const char* /*meaning*/);
  void Number(const char* key, std::optional<double>& value, const Range& range, const char* /*meaning*/);
  void Integer(const char* key, int& value, const Range& range, const char* /*meaning*/);
  void Flag(const char* key, bool& value, const char* /*meaning*/);
  void Text(const char* key, std::string& value, const char* /*meaning*/);
  void Numbers(const char* key, std::vector<double>& values, const Range& range, const char* /*meaning*/);
  void Integers(const char* key, std::vector<int>& values, const Range& range, const char* /*meaning*/);
  void Check(bool ok, const std::string& key, const std::string& rule, const Keys& reads = {});

  /// The folder to which a path given under this key is relative: that of the file in which it is written, or the
  /// working directory for an override. Empty if the key was not given.
  std::filesystem::path FolderOf(const std::string& key);

  /// "file:line" of the value at a path of the configuration, or of the map that lacks it.
  std::string PlaceOf(const std::string& path) const;

  /// All files of the configuration that were read so far.
  std::vector<std::filesystem::path> Files() const { return session_.library.Files(); }
  /// Names that have several different files; see PartLibrary.
  const std::set<std::string>& Ambiguities() const { return session_.library.Ambiguities(); }

  template <class Enum>
  void Choice(const char* key, Enum& value, Choices<Enum> choices, const char* /*meaning*/) {
    std::optional<Enum> given;
    Choice(key, given, choices, nullptr);
    if (given) value = *given;
  }
  template <class Enum>
  void Choice(const char* key, std::optional<Enum>& value, Choices<Enum> choices, const char* /*meaning*/) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    if (const std::optional<std::size_t> index = ReadChoice(key, names)) value = choices.begin()[*index].second;
  }

  template <class Struct>
  void Group(const char* key, Struct& value, const char* /*meaning*/) {
    ReadStruct(FindGroup(key, Absent::kReadAsEmpty), value);
  }
  template <class Struct>
  void Group(const char* key, std::optional<Struct>& value, const char* /*meaning*/) {
    ReadOptional(FindGroup(key, Absent::kSkip), value);
  }

  template <class Struct>
  void Part(const char* key, Struct& value, const char* kind, const char* /*meaning*/) {
    const Place place = FindPart(key, kind, TableKey<Struct>(0));
    if (place.state == Place::State::kAbsent) {
      // One error for a missing part is clearer than one for each of its fields.
      if (!IsComplete(place, value)) ReportMissingPart(key, kind);
    } else {
      ReadStruct(place, value);
    }
  }
  template <class Struct>
  void Part(const char* key, std::optional<Struct>& value, const char* kind, const char* /*meaning*/) {
    ReadOptional(FindPart(key, kind, TableKey<Struct>(0)), value);
  }

  template <class Struct>
  void List(const char* key, std::vector<Struct>& values, const char* /*meaning*/) {
    ReadList(FindList(key, nullptr), values);
  }
  template <class Struct>
  void Parts(const char* key, std::vector<Struct>& values, const char* kind, const char* /*meaning*/) {
    ReadList(FindList(key, kind), values);
  }

 private:
  template <class Struct, class Rules>
  friend Struct Load(const std::string& file, const LoadOptions& options, ErrorList& errors, const Rules& rules);
  template <class Struct>
  friend Struct LoadText(const std::string& text, const std::string& label, ErrorList& errors);

  /// A map to read a struct from, or why there is none.
  struct Place {
    enum class State { kMap, kAbsent, kNull, kBad };
    State state = State::kBad;
    NodePtr map;    ///< null: an empty map
    Source source;  ///< where an error about a missing key of it points
    KeyPath path;
    FileChain chain;  ///< the files that led here
  };
  enum class Absent { kReadAsEmpty, kSkip };

  /// A value that was given, in the file or by an override.
  struct Value {
    NodePtr node;   ///< null: not given
    Source source;  ///< of its key
    KeyPath path;
    explicit operator bool() const { return node != nullptr; }
  };

  Reader(ReadSession& session, const Place& place);

  /// The key under which a part given as a table has its rows; null: it may not be a table.
  template <class Struct>
  static auto TableKey(int /*preferred*/) -> decltype(Struct::kTableKey) {
    return Struct::kTableKey;
  }
  template <class Struct>
  static const char* TableKey(long /*otherwise*/) {
    return nullptr;
  }

  static Place RootPlace(ReadSession& session, const std::string& file, const LoadOptions& options,
                         const char* table_key);
  static Place TextPlace(ReadSession& session, const std::string& text, const std::string& label);
  static void ReportUnused(ReadSession& session);

  Value Find(const char* key);
  Value Item(const Value& list, std::size_t index);
  Place MapPlace(const Value& value);
  Place PartPlace(const Value& value, const std::string& kind);
  Place FindGroup(const char* key, Absent absent);
  Place FindPart(const char* key, const char* kind, const char* table_key);
  std::optional<std::vector<Place>> FindList(const char* key, const char* kind);
  std::optional<Value> FindItems(const char* key, const char* of_what, bool may_be_table);
  void CheckIndices(const KeyPath& list, std::size_t size);
  std::optional<std::size_t> ReadChoice(const char* key, const std::vector<std::string>& names);
  std::optional<double> ReadNumber(const Value& value, const char* key, const Range& range);
  std::optional<int> ReadInteger(const Value& value, const char* key, const Range& range);
  void NoteNumber(const char* key, double value, bool is_default);
  struct Shown;
  const Shown* FindNumber(const std::string& key) const;
  std::string WithNumbers(std::string rule, const Keys& keys) const;
  void Finish();
  void ReportMissing(const char* key, const std::string& rule);
  void ReportMissingPart(const char* key, const std::string& kind);
  KeyPath Path(const std::string& key) const;

  template <class Struct>
  void ReadStruct(const Place& place, Struct& value) {
    if (place.state == Place::State::kNull) ReportNull(place);
    if (place.state != Place::State::kMap || !Afford(place)) return;
    Reader reader(session_, place);
    value.Visit(reader);
    reader.Finish();
  }
  template <class Struct>
  void ReadOptional(const Place& place, std::optional<Struct>& value) {
    if (place.state == Place::State::kNull) value.reset();
    if (place.state != Place::State::kMap) return;
    if (!value) value.emplace();
    ReadStruct(place, *value);
  }
  template <class Struct>
  void ReadList(const std::optional<std::vector<Place>>& places, std::vector<Struct>& values) {
    if (!places) return;
    values.assign(places->size(), Struct());
    for (std::size_t i = 0; i < places->size(); ++i) ReadStruct((*places)[i], values[i]);
  }
  void ReportNull(const Place& place);
  bool Afford(const Place& place);

  /// Whether a struct may be left out: all its fields have defaults.
  template <class Struct>
  bool IsComplete(const Place& place, Struct value) {
    ErrorList missing;
    ReadSession session{missing, PartLibrary({}, missing), Overrides({}, {}, "", missing)};
    Place empty = place;
    empty.state = Place::State::kMap;
    Reader reader(session, empty);
    value.Visit(reader);
    return missing.empty();
  }

  ReadSession& session_;
  const Place place_;
  std::vector<std::string> known_;  ///< the keys that were requested

  /// A number as a rule may show it.
  struct Shown {
    double value;
    bool is_default;
    std::string Text() const { return ShortestDecimal(value) + (is_default ? ", default" : ""); }
  };
  std::vector<std::pair<const char*, Shown>> numbers_;  ///< with their keys

  struct BrokenRule {
    Source source;
    KeyPath path;
    std::string text;
    std::vector<std::string> read;  ///< paths of what it reads
  };
  std::vector<BrokenRule> broken_rules_;  ///< Checks that failed; ignored if a value that they read is invalid
};

/// Reads a struct from a YAML file and the files that it refers to, with overrides on top.
///
/// All errors are added to `errors`; use the result only if there are none.
///
/// @param rules  called as rules(Struct&, Reader&) if there are no other errors, for rules that need a calculation: it
/// calls the reader's Check with paths from the root of the configuration
template <class Struct, class Rules>
Struct Load(const std::string& file, const LoadOptions& options, ErrorList& errors, const Rules& rules) {
  Struct value;
  ReadSession session{
      errors, PartLibrary(options.search_roots, errors, options.search_remedy),
      Overrides(options.overrides, std::filesystem::path(file).parent_path(), options.root_name, errors)};
  const Reader::Place root = Reader::RootPlace(session, file, options, Reader::TableKey<Struct>(0));
  if (root.state != Reader::Place::State::kMap) return value;
  Reader reader(session, root);
  value.Visit(reader);
  reader.Finish();
  Reader::ReportUnused(session);
  if (errors.empty()) {
    rules(value, reader);
    reader.Finish();
  }
  return value;
}

template <class Struct>
Struct Load(const std::string& file, const LoadOptions& options, ErrorList& errors) {
  return Load<Struct>(file, options, errors, [](Struct&, Reader&) {});
}

/// Reads a struct from self-contained YAML text, such as Write makes: parts are maps, not names or files.
///
/// @param label   what messages name instead of a file
/// @param errors  as above
template <class Struct>
Struct LoadText(const std::string& text, const std::string& label, ErrorList& errors) {
  Struct value;
  ReadSession session{errors, PartLibrary({}, errors), Overrides({}, {}, "", errors)};
  const Reader::Place root = Reader::TextPlace(session, text, label);
  if (root.state != Reader::Place::State::kMap) return value;
  Reader reader(session, root);
  value.Visit(reader);
  reader.Finish();
  return value;
}

/// @throws Error with everything that is wrong
template <class Struct>
Struct Load(const std::string& file, const LoadOptions& options = {}) {
  ErrorList errors;
  Struct value = Load<Struct>(file, options, errors);
  if (!errors.empty()) throw Error(errors);
  return value;
}

}  // namespace strict_config
