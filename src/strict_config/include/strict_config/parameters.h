#pragma once

#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// The vocabulary in which every parameter struct describes itself.
///
/// A parameter struct lists its fields once, in a member template
///
///     template <class Visitor>
///     void Visit(Visitor& v) {
///       v.Number("wheel_radius_m", wheel_radius_m, kPositive, "r, radius of the wheels");
///       v.Check(inner <= outer, "inner_m", "must be at most outer_m");
///     }
///
/// and that one list serves the strict reader, the writer of resolved configurations, the validator and the
/// reference of all keys: a field's name, its key in YAML and the word in its error message are the same. Each
/// call ends with the key's meaning: its symbol, what it is, its sign, its source; the unit is in the key. Visitors
/// offer (the meaning left out)
///
///   Number(key, double&, Range)                 Integer(key, int&, Range)        Flag(key, bool&)
///   Text(key, std::string&)                     Choice(key, Enum&, {{"name", Enum::kName}, ...})
///   Numbers(key, std::vector<double>&, Range)   Integers(key, std::vector<int>&, Range)
///   Group(key, Struct&)       a nested map      List(key, std::vector<Struct>&)  a list of maps
///   Part(key, Struct&, kind)  a nested map that may also be a name or a file in the folder `kind`
///   Parts(key, std::vector<Struct>&, kind)      a list of them
///   Check(bool ok, key, rule) a rule between fields; only checked if all fields are valid
///   Check(bool ok, key, rule, {"other_key", ...})   the same; checked if `key` and these keys are valid, whatever
///                             other errors there are. Their numbers are shown where the rule names them.
/// The key of a Check may be a path further down: "commands[1].reduction_kpa".
///
/// Number, Group and Part also take a std::optional, which stays as it is when the key is absent.
///
/// A number whose value is kRequired (an integer: kRequiredInteger) before reading must be given; any other
/// value is its default. An absent list keeps its default; a Check says when it must not be empty.
namespace strict_config {

/// Marks a number that has no default. (Also the value that a Number may not have afterwards.)
inline constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();

/// Marks an integer that has no default.
inline constexpr int kRequiredInteger = std::numeric_limits<int>::min();

/// The interval in which a parameter's value must lie.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = true;  ///< true: min itself is outside
  bool max_open = true;  ///< true: max itself is outside

  /// False for NaN.
  constexpr bool Contains(double value) const {
    return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
  }
  /// The rule in words, e.g. "must be > 0" or "must be in [0, 1]".
  std::string Rule() const;
};

inline constexpr Range kFinite{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true, true};
inline constexpr Range kNonNegative{0.0, std::numeric_limits<double>::infinity(), false, true};
inline constexpr Range kFraction{0.0, 1.0, false, false};

/// The options of a Choice: each word that may be written, and its value.
template <class Enum>
using Choices = std::initializer_list<std::pair<const char*, Enum>>;

/// The other keys that a rule reads.
using Keys = std::vector<const char*>;

/// The shortest decimal text that reads back to exactly the same double, whatever the locale: 0.1 is "0.1".
std::string ShortestDecimal(double value);

}  // namespace strict_config
