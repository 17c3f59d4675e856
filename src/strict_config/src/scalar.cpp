#include "strict_config/scalar.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace strict_config {
namespace {

using Unit = std::pair<std::string_view, std::string_view>;

/// The units that keys end in. Left out are letters that more often mean something else (a, c, g, k, v).
constexpr Unit kUnits[] = {
    {"m", "m"},
    {"mm", "mm"},
    {"um", "um"},
    {"km", "km"},
    {"m2", "m^2"},
    {"mm2", "mm^2"},
    {"m3", "m^3"},
    {"s", "s"},
    {"ms", "ms"},
    {"us", "us"},
    {"s2", "s^2"},
    {"h", "h"},
    {"kg", "kg"},
    {"t", "t"},
    {"kgm2", "kg m^2"},
    {"n", "N"},
    {"kn", "kN"},
    {"mn", "MN"},
    {"nm", "N m"},
    {"knm", "kN m"},
    {"ns", "N s"},
    {"kns", "kN s"},
    {"nms", "N m s"},
    {"knms", "kN m s"},
    {"pa", "Pa"},
    {"kpa", "kPa"},
    {"mpa", "MPa"},
    {"gpa", "GPa"},
    {"bar", "bar"},
    {"psi", "psi"},
    {"rad", "rad"},
    {"mrad", "mrad"},
    {"deg", "degrees"},
    {"rad2", "rad^2"},
    {"hz", "Hz"},
    {"khz", "kHz"},
    {"j", "J"},
    {"kj", "kJ"},
    {"mj", "MJ"},
    {"w", "W"},
    {"kw", "kW"},
    {"mw", "MW"},
    {"kmh", "km/h"},
    {"kph", "km/h"},
    {"mps", "m/s"},
    {"mph", "miles/h"},
    {"mps2", "m/s^2"},
    {"ms2", "m/s^2"},
    {"kmh2", "(km/h)^2"},
    {"rpm", "1/min"},
    {"percent", "%"},
    {"permille", "per mille"},
    {"degc", "degrees Celsius"},
    {"kelvin", "K"},
    {"m15", "m^1.5"},
    {"lb", "lb"},
};

std::vector<std::string> Words(const std::string& key) {
  std::vector<std::string> words(1);
  for (const char c : key) {
    if (c == '_') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

/// The unit that the words from `first` on spell, as "n per m"; empty if they spell none.
std::string UnitOf(const std::vector<std::string>& words, std::size_t first) {
  std::string unit;
  bool wants_unit = false;
  for (std::size_t i = first; i < words.size(); ++i) {
    if (words[i] == "per" && !wants_unit) {
      unit += unit.empty() ? "1/" : "/";
      wants_unit = true;
      continue;
    }
    const auto known =
        std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& u) { return u.first == words[i]; });
    if (known == std::end(kUnits) || !(wants_unit || i == first)) return "";
    unit += known->second;
    wants_unit = false;
  }
  return wants_unit ? "" : unit;
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::size_t SkipDigits(const std::string& text, std::size_t i) {
  while (i < text.size() && IsDigit(text[i])) ++i;
  return i;
}

/// The length of the decimal number that the text begins with, 0 if there is none. Leading zeros are allowed
/// here.
std::size_t DecimalLength(const std::string& text) {
  std::size_t i = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t begin = i;
  i = SkipDigits(text, begin);
  std::size_t digits = i - begin;
  if (i < text.size() && text[i] == '.') {
    const std::size_t end = SkipDigits(text, i + 1);
    digits += end - i - 1;
    i = end;
  }
  if (digits == 0) return 0;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t exponent = i + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const std::size_t end = SkipDigits(text, exponent);
    if (end > exponent) i = end;
  }
  return i;
}

bool HasLeadingZero(const std::string& text) {
  const std::size_t i = text.find_first_not_of("+-");
  return i + 1 < text.size() && text[i] == '0' && IsDigit(text[i + 1]);
}

bool IsInfinityOrNan(std::string text) {
  text.erase(0, std::min(text.find_first_not_of("+-."), text.size()));
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text == "nan" || text == "inf" || text == "infinity";
}

}  // namespace

std::optional<double> ParseNumber(const std::string& text) {
  if (text.empty() || DecimalLength(text) != text.size() || HasLeadingZero(text)) return std::nullopt;
  const char* begin = text.data() + (text[0] == '+' ? 1 : 0);
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(begin, text.data() + text.size(), value);
  if (result.ec != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string NumberRule(const std::string& text, bool quoted, const std::string& key) {
  if (quoted) return ParseNumber(text) ? "must be a number without quotes" : "must be a number";
  if (IsInfinityOrNan(text)) return "must be a finite number";
  const std::size_t length = DecimalLength(text);
  if (length == 0) return "must be a number";
  if (length == text.size()) {
    return HasLeadingZero(text) ? "must be a plain decimal number, without leading zeros"
                                : "must be a number within the range of double precision";
  }
  const std::string rest = text.substr(length);
  if (text.substr(0, length) == "0" && (rest[0] == 'x' || rest[0] == 'o' || rest[0] == 'b')) {
    return "must be a plain decimal number";
  }
  if (rest[0] == ',') return "must be a plain number, with a point for decimals";
  if (rest[0] == '_') return "must be a plain number, without separators";
  const auto after_spaces = static_cast<unsigned char>(rest[std::min(rest.find_first_not_of(' '), rest.size() - 1)]);
  const bool is_unit = std::isalpha(after_spaces) || after_spaces == '%' || after_spaces >= 0x80;
  if (!is_unit) return "must be a number";
  const std::string unit = SplitUnit(key).unit;
  return unit.empty() ? "must be a plain number, without a unit"
                      : "must be a plain number in " + unit + " (the unit is in the key)";
}

KeyUnit SplitUnit(const std::string& key) {
  const std::vector<std::string> words = Words(key);
  std::string stem = words[0];
  for (std::size_t first = 1; first < words.size(); ++first) {
    const std::string unit = UnitOf(words, first);
    if (!unit.empty()) return {stem, unit};
    stem += "_" + words[first];
  }
  return {key, ""};
}

}  // namespace strict_config
