#include "strict_config/reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>

#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "strict_config/text_file.h"

namespace strict_config {
namespace {

std::string Index(std::size_t i) { return "[" + std::to_string(i) + "]"; }

std::string Joined(const std::string& path, const std::string& key) {
  return path.empty() || key.empty() ? path + key : path + "." + key;
}

/// The first key or index of what is left of a path, without dots and brackets.
std::string FirstStep(const std::string& rest) {
  const std::size_t begin = rest.find_first_not_of(".[");
  return begin == std::string::npos ? "" : rest.substr(begin, rest.find_first_of(".[]", begin) - begin);
}

bool IsIn(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Where a text holds a key as a whole word, or npos.
std::size_t FindKey(const std::string& text, const std::string& key) {
  const auto goes_on = [&text](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' || text[i] == '.');
  };
  std::size_t at = text.find(key);
  while (at != std::string::npos && ((at > 0 && goes_on(at - 1)) || goes_on(at + key.size())))
    at = text.find(key, at + 1);
  return at;
}

/// Whether text in UTF-8 has characters that control a terminal (except line feeds and tabs): control characters of
/// ASCII, those from U+0080 to U+009F, and those that turn the direction of writing.
bool HasControlCharacter(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t ahead) {
      return i + ahead < text.size() ? static_cast<unsigned char>(text[i + ahead]) : 0u;
    };
    if ((byte(0) < 0x20 && text[i] != '\n' && text[i] != '\t') || byte(0) == 0x7F) return true;
    if (byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) <= 0x9F) return true;
    const bool turns = (byte(1) == 0x80 && byte(2) >= 0xAA && byte(2) <= 0xAE) ||
                       (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
    if (byte(0) == 0xE2 && turns) return true;
  }
  return false;
}

/// Why a number cannot be what its key says; empty: it can.
std::string Doubt(const std::string& key, const std::string& path, double number,
                  const std::function<Range(const std::string& path)>& plausible_size) {
  if (!plausible_size || number == 0.0) return "";
  const Range size = plausible_size(path);
  if (size.Contains(std::fabs(number))) return "";
  const bool is_large = std::fabs(number) > size.min;
  const std::string unit = SplitUnit(key).unit;
  return "must be " + std::string(is_large ? "at most " : "at least ") +
         ShortestDecimal(is_large ? size.max : size.min) + (unit.empty() ? "" : " " + unit) +
         " in size: no train has " + (is_large ? "more" : "less") + (unit.empty() ? "" : "; is it in " + unit + "?");
}

/// A map that holds the reference to a table under a key.
NodePtr AsMap(const NodePtr& reference, const char* table_key) {
  auto map = std::make_shared<Node>();
  map->kind = Node::Kind::kMap;
  map->source = reference->source;
  map->entries.push_back({table_key, reference->source, reference});
  return map;
}

}  // namespace

ReadSession::Spot ReadSession::Locate(const std::string& path) {
  // The innermost map above the path that a struct was read from.
  std::size_t end = path.size();
  auto owner = read.end();
  while (owner == read.end() && end > 0) {
    const std::size_t step = path.find_last_of(".[", end - 1);
    end = step == std::string::npos ? 0 : step;
    owner = read.find(path.substr(0, end));
  }
  if (owner == read.end()) return {};
  Spot spot{owner->second.source, nullptr, {path, owner->second.part}};

  // From there one key, and an index where it leads into a list.
  const std::string key = FirstStep(path.substr(end));
  const std::size_t key_end = path.find(key, end) + key.size();
  const Entry* const entry = owner->second.map ? owner->second.map->Find(key) : nullptr;
  spot.value = overrides.Take(path.substr(0, key_end));
  if (!spot.value && entry) spot.value = entry->value;
  if (spot.value && spot.value->kind == Node::Kind::kList && key_end < path.size()) {
    const std::string index = FirstStep(path.substr(key_end));
    const NodePtr given = overrides.Take(path.substr(0, path.find(']', key_end) + 1));
    spot.value = given ? given : spot.value->items.at(std::stoul(index));
  }
  if (spot.value) spot.source = spot.value->source;
  return spot;
}

Reader::Reader(ReadSession& session, const Place& place) : session_(session), place_(place) {
  session.read[place.path.text] = {place.map, place.source, place.path.part};
}

void Reader::Number(const char* key, double& value, const Range& range, const char* /*meaning*/) {
  if (const Value found = Find(key)) {
    if (const std::optional<double> number = ReadNumber(found, key, range)) value = *number;
    NoteNumber(key, value, false);
  } else if (std::isnan(value)) {
    ReportMissing(key, range.Rule());
  } else {
    NoteNumber(key, value, true);
  }
}

void Reader::Number(const char* key, std::optional<double>& value, const Range& range, const char* /*meaning*/) {
  const Value found = Find(key);
  if (!found) return;
  if (const std::optional<double> number = ReadNumber(found, key, range)) value = number;
  if (value) NoteNumber(key, *value, false);
}

void Reader::Integer(const char* key, int& value, const Range& range, const char* /*meaning*/) {
  if (const Value found = Find(key)) {
    if (const std::optional<int> number = ReadInteger(found, key, range)) value = *number;
    NoteNumber(key, value, false);
  } else if (value == kRequiredInteger) {
    ReportMissing(key, range.Rule());
  } else {
    NoteNumber(key, value, true);
  }
}

void Reader::Flag(const char* key, bool& value, const char* /*meaning*/) {
  const Value found = Find(key);
  if (!found) return;
  const bool is_plain = found.node->kind == Node::Kind::kScalar && !found.node->quoted;
  if (is_plain && (found.node->text == "true" || found.node->text == "false")) {
    value = found.node->text == "true";
  } else {
    found.node->source.Report(session_.errors, found.path, "must be true or false, got " + Describe(*found.node));
  }
}

void Reader::Text(const char* key, std::string& value, const char* /*meaning*/) {
  const Value found = Find(key);
  if (!found) return;
  if (found.node->kind != Node::Kind::kScalar) {
    found.node->source.Report(session_.errors, found.path, "must be text, got " + Describe(*found.node));
  } else if (HasControlCharacter(found.node->text)) {
    found.node->source.Report(session_.errors, found.path,
                              "must be text without control characters, got " + Describe(*found.node));
  } else {
    value = found.node->text;
  }
}

void Reader::Numbers(const char* key, std::vector<double>& values, const Range& range, const char* /*meaning*/) {
  const std::optional<Value> list = FindItems(key, "numbers", /*may_be_table=*/false);
  if (!list) return;
  values.clear();
  for (std::size_t i = 0; i < list->node->items.size(); ++i) {
    values.push_back(ReadNumber(Item(*list, i), key, range).value_or(0.0));
  }
}

void Reader::Integers(const char* key, std::vector<int>& values, const Range& range, const char* /*meaning*/) {
  const std::optional<Value> list = FindItems(key, "whole numbers", /*may_be_table=*/false);
  if (!list) return;
  values.clear();
  for (std::size_t i = 0; i < list->node->items.size(); ++i) {
    values.push_back(ReadInteger(Item(*list, i), key, range).value_or(0));
  }
}

void Reader::Check(bool ok, const std::string& key, const std::string& rule, const Keys& reads) {
  if (ok) return;
  const ReadSession::Spot spot = session_.Locate(Path(key).text);
  std::string text = WithNumbers(rule, reads);
  const Shown* const number = FindNumber(key);
  const bool is_reference = session_.read.count(spot.path.text) > 0;
  if (spot.value && spot.value->kind == Node::Kind::kScalar && !is_reference) {
    text += ", got " + Describe(*spot.value);
  } else if (!spot.value && number != nullptr) {
    text += ", got " + ShortestDecimal(number->value) + " (default)";
  }
  // If the key has a map, the rule reads all of it.
  std::vector<std::string> read;
  if (!is_reference || reads.empty()) read.push_back(spot.path.text);
  for (const char* other : reads) read.push_back(Path(other).text);
  for (const std::string& other : reads.empty() ? known_ : std::vector<std::string>()) {
    if (FindKey(rule, other) != std::string::npos) read.push_back(Path(other).text);
  }
  broken_rules_.push_back({spot.source, spot.path, text, read});
}

std::filesystem::path Reader::FolderOf(const std::string& key) {
  const ReadSession::Spot spot = session_.Locate(Path(key).text);
  return spot.value ? spot.source.document->folder : std::filesystem::path();
}

std::string Reader::PlaceOf(const std::string& path) const {
  const Source source = session_.Locate(Path(path).text).source;
  const bool has_line = source.document->has_lines && source.line > 0;
  return source.document->label + (has_line ? ":" + std::to_string(source.line) : "");
}

void Reader::NoteNumber(const char* key, double value, bool is_default) {
  numbers_.push_back({key, {value, is_default}});
}

const Reader::Shown* Reader::FindNumber(const std::string& key) const {
  const auto found =
      std::find_if(numbers_.rbegin(), numbers_.rend(), [&key](const auto& number) { return number.first == key; });
  return found == numbers_.rend() ? nullptr : &found->second;
}

std::string Reader::WithNumbers(std::string rule, const Keys& keys) const {
  for (const std::string key : keys) {
    const Shown* const number = FindNumber(key);
    const std::size_t at = FindKey(rule, key);
    if (number == nullptr || at == std::string::npos) continue;
    rule.insert(at + key.size(), " (" + number->Text() + ")");
  }
  return rule;
}

std::optional<std::size_t> Reader::ReadChoice(const char* key, const std::vector<std::string>& names) {
  const Value found = Find(key);
  if (!found) return std::nullopt;
  const bool is_scalar = found.node->kind == Node::Kind::kScalar;
  if (is_scalar) {
    const auto chosen = std::find(names.begin(), names.end(), found.node->text);
    if (chosen != names.end()) return static_cast<std::size_t>(chosen - names.begin());
  }
  const std::string nearest = is_scalar ? Nearest(found.node->text, names) : "";
  found.node->source.Report(session_.errors, found.path,
                            "must be one of " + Join(names, names.size()) + ", got " + Describe(*found.node) +
                                (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  return std::nullopt;
}

std::optional<double> Reader::ReadNumber(const Value& value, const char* key, const Range& range) {
  const Node& node = *value.node;
  const bool is_scalar = node.kind == Node::Kind::kScalar;
  const std::optional<double> number = is_scalar && !node.quoted ? ParseNumber(node.text) : std::nullopt;
  if (number && range.Contains(*number)) {
    const std::string doubt = Doubt(key, Path(key).text, *number, session_.plausible_size);
    if (doubt.empty()) return number;
    node.source.Report(session_.errors, value.path, doubt + ", got " + Describe(node));
    return std::nullopt;
  }
  const std::string rule = number      ? range.Rule()
                           : is_scalar ? NumberRule(node.text, node.quoted, key)
                                       : "must be a number";
  node.source.Report(session_.errors, value.path, rule + ", got " + Describe(node));
  return std::nullopt;
}

std::optional<int> Reader::ReadInteger(const Value& value, const char* key, const Range& range) {
  const std::optional<double> number = ReadNumber(value, key, range);
  if (!number) return std::nullopt;
  constexpr double kLargest = std::numeric_limits<int>::max();
  const bool is_whole = std::floor(*number) == *number;
  if (is_whole && std::fabs(*number) <= kLargest) return static_cast<int>(*number);
  value.node->source.Report(
      session_.errors, value.path,
      (is_whole ? "must be within the range of an integer, got " : "must be a whole number, got ") +
          Describe(*value.node));
  return std::nullopt;
}

Reader::Value Reader::Find(const char* key) {
  if (!IsIn(known_, key)) known_.emplace_back(key);
  const KeyPath path = Path(key);
  if (const NodePtr given = session_.overrides.Take(path.text)) return {given, given->source, path};
  const Entry* const entry = place_.map ? place_.map->Find(key) : nullptr;
  return entry ? Value{entry->value, entry->source, path} : Value{nullptr, place_.source, path};
}

Reader::Value Reader::Item(const Value& list, std::size_t index) {
  const KeyPath path{list.path.text + Index(index), list.path.part};
  NodePtr node = session_.overrides.Take(path.text);
  if (!node) node = list.node->items[index];
  return {node, node->source, path};
}

std::optional<Reader::Value> Reader::FindItems(const char* key, const char* of_what, bool may_be_table) {
  Value found = Find(key);
  if (may_be_table && found && IsTableReference(*found.node)) {
    found.node = session_.library.ResolveTable(found.node, found.path);
    if (!found) return std::nullopt;  // reported
  }
  const bool is_list = found && found.node->kind == Node::Kind::kList;
  CheckIndices(found.path, is_list ? found.node->items.size() : 0);
  if (is_list) {
    const std::size_t size = found.node->items.size();
    session_.values_left -= std::min(size, session_.values_left);
    return found;
  }
  if (found) {
    found.node->source.Report(session_.errors, found.path,
                              std::string("must be a list of ") + of_what + ", got " + Describe(*found.node));
  }
  return std::nullopt;
}

void Reader::CheckIndices(const KeyPath& list, std::size_t size) {
  for (Override* const given : session_.overrides.Below(list.text)) {
    const std::string rest = given->path.substr(list.text.size());
    const std::string step = FirstStep(rest);
    // Nine digits are more entries than any list may have, and fit an integer.
    if (rest[0] == '[' && step.size() <= 9 && std::stoul(step) < size) continue;
    given->used = true;
    given->value->source.Report(session_.errors, list,
                                "has no entry " + step + "; " +
                                    (size == 0 ? "it has none" : "its entries are 0 to " + std::to_string(size - 1)));
  }
}

Reader::Place Reader::MapPlace(const Value& value) {
  Place place;
  place.source = value.source;
  place.path = value.path;
  place.chain = place_.chain;
  if (value.node->is_row) place.path.part = place.path.text.size();
  if (value.node->kind == Node::Kind::kMap) {
    place.state = Place::State::kMap;
    place.map = value.node;
  } else if (value.node->kind == Node::Kind::kNull) {
    place.state = Place::State::kNull;
  } else {
    value.node->source.Report(session_.errors, value.path, "must be a map, got " + Describe(*value.node));
  }
  return place;
}

Reader::Place Reader::PartPlace(const Value& value, const std::string& kind) {
  if (value.node->kind == Node::Kind::kNull) return MapPlace(value);
  Place place;
  place.path = value.path;
  place.chain = place_.chain;
  place.map = session_.library.Resolve(value.node, kind, value.path, place.chain);
  if (!place.map) return place;
  place.state = Place::State::kMap;
  place.source = value.node->kind == Node::Kind::kScalar ? place.map->source : value.source;
  const bool is_shared = place.chain.size() > place_.chain.size();
  if (is_shared) place.path.part = place.path.text.size();
  return place;
}

Reader::Place Reader::FindGroup(const char* key, Absent absent) {
  const Value found = Find(key);
  if (found) return MapPlace(found);
  const bool is_read = absent == Absent::kReadAsEmpty || !session_.overrides.Below(found.path.text).empty();
  return {is_read ? Place::State::kMap : Place::State::kAbsent, nullptr, found.source, found.path, place_.chain};
}

Reader::Place Reader::FindPart(const char* key, const char* kind, const char* table_key) {
  Value found = Find(key);
  if (found && table_key != nullptr && IsTableReference(*found.node)) found.node = AsMap(found.node, table_key);
  if (found) return PartPlace(found, kind);
  const bool is_read = !session_.overrides.Below(found.path.text).empty();
  return {is_read ? Place::State::kMap : Place::State::kAbsent, nullptr, found.source, found.path, place_.chain};
}

std::optional<std::vector<Reader::Place>> Reader::FindList(const char* key, const char* kind) {
  const std::optional<Value> list = FindItems(key, kind ? "parts" : "maps", /*may_be_table=*/true);
  if (!list) return std::nullopt;
  const std::size_t size = list->node->items.size();
  if (size > ReadSession::kMaxItems) {
    list->node->source.Report(
        session_.errors, list->path,
        "has " + std::to_string(size) + " entries; the limit is " + std::to_string(ReadSession::kMaxItems));
    return std::nullopt;
  }
  std::vector<Place> places;
  places.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const Value item = Item(*list, i);
    places.push_back(kind ? PartPlace(item, kind) : MapPlace(item));
  }
  return places;
}

void Reader::Finish() {
  static const std::vector<Entry> kNone;
  for (const Entry& entry : place_.map ? place_.map->entries : kNone) {
    if (IsIn(known_, entry.key)) continue;
    const std::string hint = session_.errors.full() ? "" : KeyHint(entry.key, known_);
    entry.source.Report(session_.errors, Path(Printable(entry.key)), "is not a known key" + hint);
  }
  for (Override* const given : session_.overrides.Below(place_.path.text)) {
    const std::string step = FirstStep(given->path.substr(place_.path.text.size()));
    if (IsIn(known_, step)) continue;
    given->used = true;
    given->value->source.Report(session_.errors, Path(step), "is not a known key" + KeyHint(step, known_));
  }
  // All rules are checked before the first is reported: one broken rule does not make another void.
  const auto is_read = [this](const std::string& path) { return session_.read.count(path) > 0; };
  const auto is_void = [&](const BrokenRule& rule) {
    return std::any_of(rule.read.begin(), rule.read.end(),
                       [&](const std::string& path) { return session_.errors.Concerns(path, is_read); });
  };
  broken_rules_.erase(std::remove_if(broken_rules_.begin(), broken_rules_.end(), is_void), broken_rules_.end());
  for (const BrokenRule& rule : broken_rules_) rule.source.Report(session_.errors, rule.path, rule.text);
  broken_rules_.clear();
}

void Reader::ReportMissing(const char* key, const std::string& rule) {
  place_.source.Report(session_.errors, Path(key), "is missing (" + rule + ")");
}

void Reader::ReportMissingPart(const char* key, const std::string& kind) {
  ReportMissing(key, "must be a map, a file, or a name from " + kind + "/");
}

void Reader::ReportNull(const Place& place) {
  place.source.Report(session_.errors, place.path, "must be a map, got nothing");
}

bool Reader::Afford(const Place& place) {
  const std::size_t cost = 1 + (place.map ? place.map->entries.size() : 0);
  if (session_.values_left >= cost) {
    session_.values_left -= cost;
    return true;
  }
  session_.values_left = 0;
  // Without a path: reported once, not for every place that is omitted.
  place.source.Report(session_.errors, "", "unfolds, through its references, to more values than are read");
  return false;
}

KeyPath Reader::Path(const std::string& key) const { return {Joined(place_.path.text, key), place_.path.part}; }

Reader::Place Reader::RootPlace(ReadSession& session, const std::string& file, const LoadOptions& options,
                                const char* table_key) {
  Place place;
  session.plausible_size = options.plausible_size;
  place.path = options.root_name;
  if (table_key != nullptr && std::filesystem::path(file).extension() == ".csv") {
    auto reference = std::make_shared<Node>();
    reference->kind = Node::Kind::kScalar;
    reference->text = file;
    reference->source.document = std::make_shared<const Document>(Document{DisplayPath(file), "", "", false});
    place.source = reference->source;
    place.map = AsMap(reference, table_key);
    place.state = Place::State::kMap;
    return place;
  }
  const NodePtr root = session.library.Open(file, place.path);
  if (!root) return place;
  const std::filesystem::path& folder = root->source.document->folder;
  place.chain.push_back(folder / std::filesystem::path(file).filename());
  const std::string kind = options.kind.empty() ? folder.filename().string() : options.kind;
  place.map = session.library.Resolve(root, kind, place.path, place.chain);
  if (!place.map) return place;
  place.source = root->source;
  place.state = Place::State::kMap;
  return place;
}

Reader::Place Reader::TextPlace(ReadSession& session, const std::string& text, const std::string& label) {
  Place place;
  const NodePtr root = session.library.OpenText(text, label, place.path);
  if (!root) return place;
  place.map = session.library.Resolve(root, "", place.path, place.chain);
  if (!place.map) return place;
  place.source = root->source;
  place.state = Place::State::kMap;
  return place;
}

void Reader::ReportUnused(ReadSession& session) {
  // After another error, the value may simply not have been read.
  if (!session.errors.empty()) return;
  for (const Override* const given : session.overrides.Unused()) {
    given->value->source.Report(session.errors, given->path, "names no value of the configuration");
  }
}

}  // namespace strict_config
