#include "train_sim/json_schema.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "strict_config/scalar.h"

namespace train_sim {
namespace {

using Json = nlohmann::ordered_json;
using strict_config::KeyCondition;
using strict_config::KeyDescription;
using strict_config::Range;
using Kind = KeyDescription::Kind;

/// Whether a map is whole, or only changes what its base gives.
enum class Extent { kWhole, kChange };

std::string FileOf(const std::string& folder) {
  for (const train_dynamics::config::FileKind& kind : train_dynamics::config::ConfigurationKeys()) {
    if (kind.folder == folder) return kind.name + ".schema.json";
  }
  throw std::logic_error("no kind of file has the folder " + folder);
}

Json NumberSchema(const char* type, const Range& range) {
  Json schema{{"type", type}};
  if (std::isfinite(range.min)) schema[range.min_open ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) schema[range.max_open ? "exclusiveMaximum" : "maximum"] = range.max;
  return schema;
}

/// A word as YAML may read it: plain true and false are no text.
Json Words(const std::vector<std::string>& words) {
  Json values = Json::array();
  for (const std::string& word : words) {
    values.push_back(word);
    if (word == "true" || word == "false") values.push_back(word == "true");
  }
  return values;
}

Json MapSchema(const std::vector<KeyDescription>& keys, Extent extent, bool may_have_base);

Json TypeOf(const KeyDescription& key, Extent extent) {
  const auto or_nothing = [&key](Json schema) {
    // An optional value may also be `null`, whatever its base gives.
    return key.may_be_left_out ? Json{{"anyOf", {std::move(schema), {{"type", "null"}}}}} : schema;
  };
  switch (key.kind) {
    case Kind::kNumber:
      return NumberSchema("number", key.range);
    case Kind::kInteger:
      return NumberSchema("integer", key.range);
    case Kind::kFlag:
      return {{"type", "boolean"}};
    case Kind::kText:
      return {{"type", {"string", "number", "boolean"}}};
    case Kind::kChoice:
      return {{"enum", Words(key.choices)}};
    case Kind::kNumbers:
      return {{"type", "array"}, {"items", NumberSchema("number", key.range)}};
    case Kind::kIntegers:
      return {{"type", "array"}, {"items", NumberSchema("integer", key.range)}};
    case Kind::kGroup:
      return or_nothing(MapSchema(key.keys, extent, false));
    case Kind::kPart: {
      const std::string file = FileOf(key.folder);
      const std::string map = extent == Extent::kWhole ? file : file + "#/definitions/change";
      return or_nothing({{"anyOf", {{{"type", "string"}}, {{"$ref", map}}}}});
    }
    case Kind::kList:
      return {{"anyOf",
               {{{"type", "string"}, {"pattern", "\\.csv$"}},
                {{"type", "array"}, {"items", MapSchema(key.keys, Extent::kWhole, false)}}}}};
    case Kind::kParts:
      return {{"anyOf",
               {{{"type", "string"}, {"pattern", "\\.csv$"}},
                {{"type", "array"}, {"items", {{"anyOf", {{{"type", "string"}}, {{"$ref", FileOf(key.folder)}}}}}}}}}};
  }
  return {};
}

Json DefaultOf(const KeyDescription& key) {
  switch (key.kind) {
    case Kind::kNumber:
    case Kind::kInteger:
    case Kind::kFlag:
    case Kind::kNumbers:
    case Kind::kIntegers:
      return Json::parse(key.default_value);
    default:
      return key.default_value;
  }
}

const KeyDescription& Find(const std::vector<KeyDescription>& keys, const std::string& key) {
  for (const KeyDescription& described : keys) {
    if (described.key == key) return described;
  }
  throw std::logic_error("no key " + key);
}

Json IsGiven(const std::string& key) { return {{"required", Json::array({key})}}; }
Json Not(Json schema) { return {{"not", std::move(schema)}}; }

/// The schema of maps for which a condition does not hold.
///
/// If a map only changes a base, a key that it does not give is unknown: the schema does not hold then.
Json Fails(const KeyCondition& condition, const std::vector<KeyDescription>& keys, Extent extent) {
  const KeyDescription& selector = Find(keys, condition.key);
  const std::string& first = condition.values.front();
  if (first == "given") return extent == Extent::kWhole ? Not(IsGiven(condition.key)) : Json(false);
  if (first == "not given") return IsGiven(condition.key);
  Json value;
  bool default_holds = false;
  if (first.rfind("> ", 0) == 0) {
    value = {{"maximum", std::stod(first.substr(2))}};
  } else {
    value = {{"not", {{"enum", Words(condition.values)}}}};
    for (const std::string& word : condition.values) default_holds = default_holds || word == selector.default_value;
  }
  Json given = IsGiven(condition.key);
  given["properties"] = {{condition.key, std::move(value)}};
  if (default_holds || extent == Extent::kChange) return given;
  return {{"anyOf", {std::move(given), Not(IsGiven(condition.key))}}};
}

Json MapSchema(const std::vector<KeyDescription>& keys, Extent extent, bool may_have_base) {
  Json properties = Json::object(), required = Json::array(), rules = Json::array();
  if (may_have_base) {
    properties["base"] = {{"type", "string"}, {"description", "the part that this one starts from: a name, or a file"}};
  }
  for (const KeyDescription& key : keys) {
    const auto is_same_key = [&key](const KeyDescription& other) { return other.key == key.key; };
    const bool is_only = std::count_if(keys.begin(), keys.end(), is_same_key) == 1;
    Json property = TypeOf(key, extent);
    const std::string unit = strict_config::SplitUnit(key.key).unit;
    property["description"] = key.meaning + (unit.empty() ? "" : " [" + unit + "]");
    if (!key.default_value.empty() && !key.IsListOfMaps()) property["default"] = DefaultOf(key);

    Json unknown = Json::array();
    for (const KeyCondition& condition : key.known_with) unknown.push_back(Fails(condition, keys, extent));
    if (is_only) {
      properties[key.key] = property;
      if (!unknown.empty())
        rules.push_back({{"if", {{"anyOf", unknown}}}, {"then", {{"properties", {{key.key, false}}}}}});
    } else {
      // One of several structs, as the value of another key says, if it is there.
      properties[key.key]["anyOf"].push_back(property);
      if (extent == Extent::kWhole)
        rules.push_back({{"if", {{"anyOf", unknown}}}, {"else", {{"properties", {{key.key, property}}}}}});
    }

    const bool may_be_missing = key.may_be_left_out && key.required_with.empty();
    if (may_be_missing || extent == Extent::kChange) continue;
    Json not_required = unknown;
    for (const KeyCondition& condition : key.required_with) not_required.push_back(Fails(condition, keys, extent));
    if (not_required.empty()) {
      required.push_back(key.key);
    } else {
      rules.push_back({{"if", {{"anyOf", not_required}}}, {"else", IsGiven(key.key)}});
    }
  }
  Json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  if (!rules.empty()) schema["allOf"] = std::move(rules);
  return schema;
}

}  // namespace

std::string JsonSchema(const train_dynamics::config::FileKind& kind) {
  const Json schema{
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", kind.name},
      {"description", kind.meaning},
      {"type", "object"},
      {"if", IsGiven("base")},
      {"then", {{"$ref", "#/definitions/change"}}},
      {"else", {{"$ref", "#/definitions/whole"}}},
      {"definitions",
       {{"whole", MapSchema(kind.keys, Extent::kWhole, false)},
        {"change", MapSchema(kind.keys, Extent::kChange, true)}}},
  };
  return schema.dump(1) + "\n";
}

}  // namespace train_sim
