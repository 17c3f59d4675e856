#include "train_node/node_parameters.h"

#include <fmt/format.h>
#include <ros/param.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "strict_config/suggestion.h"

namespace train_node {
namespace {

using XmlRpc::XmlRpcValue;

std::string Described(const XmlRpcValue& value) {
  XmlRpcValue copy = value;  // its conversions are not const
  switch (copy.getType()) {
    case XmlRpcValue::TypeString:
      return "the text '" + static_cast<std::string&>(copy) + "'";
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool&>(copy) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return fmt::format("{}", static_cast<int&>(copy));
    case XmlRpcValue::TypeDouble:
      return fmt::format("{}", static_cast<double&>(copy));
    case XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpcValue::TypeStruct:
      return "a map";
    default:
      return "something else";
  }
}

XmlRpcValue Fetch(const std::string& node) {
  XmlRpcValue values;
  ros::param::get(node, values);
  return values;
}

}  // namespace

NodeParameters::NodeParameters(const std::string& node) : NodeParameters(Fetch(node)) {}

NodeParameters::NodeParameters(const XmlRpcValue& values) {
  if (values.getType() == XmlRpcValue::TypeStruct) values_ = values;
}

bool NodeParameters::Has(const std::string& name) const {
  return values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(name);
}

void NodeParameters::Complain(const std::string& name, const std::string& rule) {
  errors_.push_back(fmt::format("parameter {} {}{}", name, rule, Has(name) ? ", got " + Described(values_[name]) : ""));
}

const XmlRpcValue* NodeParameters::Find(const std::string& name, std::initializer_list<XmlRpcValue::Type> types,
                                        const char* rule) {
  known_.insert(name);
  if (!Has(name)) return nullptr;
  const XmlRpcValue& value = values_[name];
  if (std::find(types.begin(), types.end(), value.getType()) != types.end()) return &value;
  Complain(name, rule);
  return nullptr;
}

std::string NodeParameters::Text(const std::string& name, const std::string& fallback) {
  const XmlRpcValue* const value = Find(name, {XmlRpcValue::TypeString}, "must be text");
  return value == nullptr ? fallback : static_cast<std::string>(XmlRpcValue(*value));
}

std::string NodeParameters::Words(const std::string& name) {
  const XmlRpcValue* const value =
      Find(name, {XmlRpcValue::TypeString, XmlRpcValue::TypeInt}, "must be words separated by blanks");
  if (value == nullptr) return "";
  XmlRpcValue copy = *value;
  return copy.getType() == XmlRpcValue::TypeInt ? std::to_string(static_cast<int>(copy))
                                                : static_cast<std::string>(copy);
}

bool NodeParameters::Flag(const std::string& name, bool fallback) {
  const XmlRpcValue* const value = Find(name, {XmlRpcValue::TypeBoolean}, "must be true or false");
  return value == nullptr ? fallback : static_cast<bool>(XmlRpcValue(*value));
}

int NodeParameters::Integer(const std::string& name, int fallback, int least) {
  const XmlRpcValue* const value = Find(name, {XmlRpcValue::TypeInt}, "must be an integer");
  if (value == nullptr) return fallback;
  const int number = static_cast<int>(XmlRpcValue(*value));
  if (number >= least) return number;
  Complain(name, fmt::format("must be >= {}", least));
  return fallback;
}

double NodeParameters::NonNegative(const std::string& name, double fallback) {
  const XmlRpcValue* const value =
      Find(name, {XmlRpcValue::TypeDouble, XmlRpcValue::TypeInt}, "must be a plain number >= 0");
  if (value == nullptr) return fallback;
  XmlRpcValue copy = *value;
  const double number = copy.getType() == XmlRpcValue::TypeInt ? static_cast<int>(copy) : static_cast<double>(copy);
  if (number >= 0.0 && std::isfinite(number)) return number;
  Complain(name, "must be >= 0 and finite");
  return fallback;
}

bool NodeParameters::IsFirstOf(const std::string& name, const std::string& first, const std::string& second) {
  return Choice(name, {first, second}) == first;
}

std::string NodeParameters::Choice(const std::string& name, const std::vector<std::string>& words) {
  known_.insert(name);
  if (!Has(name)) return words.front();
  XmlRpcValue value = values_[name];
  const std::string word = value.getType() == XmlRpcValue::TypeString    ? static_cast<std::string>(value)
                           : value.getType() == XmlRpcValue::TypeBoolean ? (static_cast<bool>(value) ? "true" : "false")
                                                                         : "";
  if (std::find(words.begin(), words.end(), word) != words.end()) return word;
  const std::vector<std::string> but_last(words.begin(), words.end() - 1);
  Complain(name, fmt::format("must be {} or {}", fmt::join(but_last, ", "), words.back()));
  return words.front();
}

std::vector<std::string> NodeParameters::Names() const {
  std::vector<std::string> names;
  if (values_.getType() != XmlRpcValue::TypeStruct) return names;
  XmlRpcValue values = values_;
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

void NodeParameters::ThrowIfWrong() const {
  std::vector<std::string> errors = errors_;
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const std::string& name : Names()) {
    if (known_.count(name) > 0) continue;
    errors.push_back(
        fmt::format("parameter {} is not known{}", name, strict_config::KeyHint(name, known, "parameter")));
  }
  if (!errors.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(errors, "\n")));
}

}  // namespace train_node
