#include "strict_config/validate.h"

#include <cmath>
#include <stdexcept>

namespace strict_config {

void Validator::Number(const char* key, double value, const Range& range, const char* /*meaning*/) {
  if (std::isnan(value)) {
    Report(key, "is missing (" + range.Rule() + ")");
  } else if (!range.Contains(value)) {
    Report(key, range.Rule() + ", got " + ShortestDecimal(value));
  }
}

void Validator::Integer(const char* key, int value, const Range& range, const char* /*meaning*/) {
  if (value == kRequiredInteger) {
    Report(key, "is missing (" + range.Rule() + ")");
  } else if (!range.Contains(value)) {
    Report(key, range.Rule() + ", got " + std::to_string(value));
  }
}

void Validator::Numbers(const char* key, const std::vector<double>& values, const Range& range,
                        const char* /*meaning*/) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (range.Contains(values[i])) continue;
    Report(key + ("[" + std::to_string(i) + "]"), range.Rule() + ", got " + ShortestDecimal(values[i]));
  }
}

void Validator::Integers(const char* key, const std::vector<int>& values, const Range& range, const char* /*meaning*/) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (range.Contains(values[i])) continue;
    Report(key + ("[" + std::to_string(i) + "]"), range.Rule() + ", got " + std::to_string(values[i]));
  }
}

void Validator::Check(bool ok, const std::string& key, const std::string& rule, const Keys& /*reads*/) {
  if (!ok && errors_.size() == first_error_) Report(key, rule);
}

void Validator::Report(const std::string& key, const std::string& rule) { errors_.push_back(path_ + key + " " + rule); }

void ThrowIfAny(const std::vector<std::string>& errors) {
  if (errors.empty()) return;
  std::string text;
  for (const std::string& error : errors) text += (text.empty() ? "" : "\n") + error;
  throw std::invalid_argument(text);
}

}  // namespace strict_config
