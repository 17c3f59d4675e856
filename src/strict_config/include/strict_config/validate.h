#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "strict_config/parameters.h"

namespace strict_config {

/// The visitor behind Validate(): checks each field against its range and collects the errors, in visit order.
class Validator {
 public:
  void Number(const char* key, double value, const Range& range, const char* /*meaning*/);
  void Number(const char* key, const std::optional<double>& value, const Range& range, const char* /*meaning*/) {
    if (value) Number(key, *value, range, nullptr);
  }
  void Integer(const char* key, int value, const Range& range, const char* /*meaning*/);
  void Flag(const char*, bool, const char* /*meaning*/) {}
  void Text(const char*, const std::string&, const char* /*meaning*/) {}
  void Numbers(const char* key, const std::vector<double>& values, const Range& range, const char* /*meaning*/);
  void Integers(const char* key, const std::vector<int>& values, const Range& range, const char* /*meaning*/);
  void Check(bool ok, const std::string& key, const std::string& rule, const Keys& reads = {});

  template <class Enum>
  void Choice(const char* key, Enum value, Choices<Enum> choices, const char* /*meaning*/) {
    for (const auto& choice : choices) {
      if (choice.second == value) return;
    }
    Report(key, "must be one of its named values");
  }
  template <class Enum>
  void Choice(const char* key, std::optional<Enum> value, Choices<Enum> choices, const char* /*meaning*/) {
    if (value) Choice(key, *value, choices, nullptr);
  }

  template <class Struct>
  void Group(const char* key, Struct& value, const char* /*meaning*/) {
    VisitNested(key, value);
  }
  template <class Struct>
  void Group(const char* key, std::optional<Struct>& value, const char* /*meaning*/) {
    if (value) VisitNested(key, *value);
  }
  template <class Value>
  void Part(const char* key, Value& value, const char* /*kind*/, const char* /*meaning*/) {
    Group(key, value, nullptr);
  }
  template <class Struct>
  void List(const char* key, std::vector<Struct>& values, const char* /*meaning*/) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      VisitNested(key + ("[" + std::to_string(i) + "]"), values[i]);
    }
  }
  template <class Struct>
  void Parts(const char* key, std::vector<Struct>& values, const char* /*kind*/, const char* /*meaning*/) {
    List(key, values, nullptr);
  }

  const std::vector<std::string>& errors() const { return errors_; }

 private:
  void Report(const std::string& key, const std::string& rule);

  template <class Struct>
  void VisitNested(const std::string& key, Struct& value) {
    const std::string outer_path = path_;
    const std::size_t outer_first_error = first_error_;
    path_ += key + ".";
    first_error_ = errors_.size();
    value.Visit(*this);
    path_ = outer_path;
    first_error_ = outer_first_error;
  }

  std::string path_;             ///< of the struct being visited, with a dot at its end; empty at the root
  std::size_t first_error_ = 0;  ///< the number of errors when the visit of that struct began
  std::vector<std::string> errors_;
};

/// Throws std::invalid_argument with one line for each error, if there is any.
void ThrowIfAny(const std::vector<std::string>& errors);

/// Checks a parameter struct that was built in code by the same rules, in the same words, as one read from a
/// file.
///
/// @throws std::invalid_argument with one line for each violation: "wheel_radius_m must be > 0, got -0.4".
template <class Struct>
void Validate(const Struct& value) {
  Struct copy = value;  // Visit is not const, because the reader writes through it.
  Validator validator;
  copy.Visit(validator);
  ThrowIfAny(validator.errors());
}

}  // namespace strict_config
