#include "strict_config/describer.h"

namespace strict_config {
namespace {

constexpr const char* kGiven = "given";
constexpr const char* kNotGiven = "not given";

template <class Numbers>
std::string ListText(const Numbers& values) {
  std::string text;
  for (const auto value : values) text += (text.empty() ? "" : ", ") + ShortestDecimal(static_cast<double>(value));
  return "[" + text + "]";
}

template <class Items>
auto FindSame(Items& items, const KeyDescription& described) {
  return std::find_if(items.begin(), items.end(),
                      [&described](const KeyDescription& item) { return item.IsSame(described); });
}

}  // namespace

std::string KeyCondition::Text() const {
  std::string text = key;
  for (std::size_t i = 0; i < values.size(); ++i) text += (i == 0 ? " " : " or ") + values[i];
  return text;
}

KeyDescription& Describer::Add(const char* key, KeyDescription::Kind kind, const char* meaning) {
  KeyDescription described;
  described.key = key;
  described.kind = kind;
  described.meaning = meaning;
  keys_.push_back(std::move(described));
  return keys_.back();
}

const KeyDescription* Describer::Known(const KeyDescription& described) const {
  const auto known = FindSame(known_, described);
  return known == known_.end() ? nullptr : &*known;
}

void Describer::Number(const char* key, double& value, const Range& range, const char* meaning) {
  KeyDescription& described = Add(key, KeyDescription::Kind::kNumber, meaning);
  described.range = range;
  if (std::isnan(value)) {
    described.may_be_left_out = false;
  } else {
    described.default_value = ShortestDecimal(value);
  }
}

void Describer::Number(const char* key, std::optional<double>& value, const Range& range, const char* meaning) {
  KeyDescription& described = Add(key, KeyDescription::Kind::kNumber, meaning);
  described.range = range;
  if (value) {
    described.default_value = ShortestDecimal(*value);
  } else {
    selectors_.push_back({key, kNotGiven, {kGiven}});
  }
  if (set_.first == key) value = range.Contains(1.0) ? 1.0 : 0.5 * (range.min + range.max);
}

void Describer::Integer(const char* key, int& value, const Range& range, const char* meaning) {
  KeyDescription& described = Add(key, KeyDescription::Kind::kInteger, meaning);
  described.range = range;
  if (value == kRequiredInteger) {
    described.may_be_left_out = false;
    return;
  }
  described.default_value = std::to_string(value);
  if (range.Contains(value + 1.0)) {
    selectors_.push_back({key, described.default_value, {"> " + described.default_value}});
    if (set_.first == key) ++value;
  }
}

void Describer::Flag(const char* key, bool& value, const char* meaning) {
  Add(key, KeyDescription::Kind::kFlag, meaning).default_value = value ? "true" : "false";
  selectors_.push_back({key, value ? "true" : "false", {value ? "false" : "true"}});
  if (set_.first == key) value = set_.second == "true";
}

void Describer::Text(const char* key, const std::string& value, const char* meaning) {
  Add(key, KeyDescription::Kind::kText, meaning).default_value = value;
}

void Describer::Numbers(const char* key, const std::vector<double>& values, const Range& range, const char* meaning) {
  KeyDescription& described = Add(key, KeyDescription::Kind::kNumbers, meaning);
  described.range = range;
  described.default_value = ListText(values);
}

void Describer::Integers(const char* key, const std::vector<int>& values, const Range& range, const char* meaning) {
  KeyDescription& described = Add(key, KeyDescription::Kind::kIntegers, meaning);
  described.range = range;
  described.default_value = ListText(values);
}

void KeyCollection::Take(const Describer& visit, const std::pair<std::string, std::string>& set) {
  if (visits_.empty()) selectors_ = visit.selectors();
  Visit taken{set, {}};
  auto before = keys_.end();  // where a new key goes: before the one that is called after it
  for (auto described = visit.keys().rbegin(); described != visit.keys().rend(); ++described) {
    KeyDescription called;
    called.key = described->key;
    called.type = described->type;
    taken.called.emplace_back(std::move(called), !described->may_be_left_out);
    const auto known = FindSame(keys_, *described);
    before = known == keys_.end() ? keys_.insert(before, *described) : known;
  }
  visits_.push_back(std::move(taken));
}

std::vector<KeyDescription> KeyCollection::Finish() const {
  const auto called_in = [](const Visit& visit, const KeyDescription& key) {
    return std::find_if(visit.called.begin(), visit.called.end(),
                        [&key](const auto& called) { return called.first.IsSame(key); });
  };
  std::vector<KeyDescription> keys = keys_;
  for (KeyDescription& described : keys) {
    const auto is_known = [&](const Visit& visit) { return called_in(visit, described) != visit.called.end(); };
    const auto is_required = [&](const Visit& visit) {
      const auto called = called_in(visit, described);
      return called != visit.called.end() && called->second;
    };
    const bool required_anywhere = std::any_of(visits_.begin(), visits_.end(), is_required);
    for (const Describer::Selector& selector : selectors_) {
      // The values of this selector, all others as they are, for which something holds.
      KeyCondition known{selector.key, {}}, required{selector.key, {}};
      std::vector<std::string> all{selector.value};
      all.insert(all.end(), selector.others.begin(), selector.others.end());
      for (const std::string& value : all) {
        const auto visit = std::find_if(visits_.begin() + 1, visits_.end(),
                                        [&](const Visit& v) { return v.set == std::make_pair(selector.key, value); });
        const Visit& with = value == selector.value ? visits_.front() : *visit;
        if (is_known(with)) known.values.push_back(value);
        if (is_required(with)) required.values.push_back(value);
      }
      if (!known.values.empty() && known.values.size() < all.size()) described.known_with.push_back(known);
      if (required_anywhere && !required.values.empty() && required.values.size() < known.values.size())
        described.required_with.push_back(required);
    }
    described.is_required_by_default = is_required(visits_.front());
    described.may_be_left_out = !required_anywhere || !described.required_with.empty();
    // What is left out where it need not be given has no default that means anything elsewhere.
    if (required_anywhere) described.default_value.clear();
  }
  return keys;
}

}  // namespace strict_config
