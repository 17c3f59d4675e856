#include "strict_config/parameters.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace strict_config {

std::string Range::Rule() const {
  const bool has_min = std::isfinite(min);
  const bool has_max = std::isfinite(max);
  if (has_min && has_max) {
    return "must be in " + std::string(min_open ? "(" : "[") + ShortestDecimal(min) + ", " + ShortestDecimal(max) +
           (max_open ? ")" : "]");
  }
  if (has_min) return (min_open ? "must be > " : "must be >= ") + ShortestDecimal(min);
  if (has_max) return (max_open ? "must be < " : "must be <= ") + ShortestDecimal(max);
  return "must be a finite number";
}

std::string ShortestDecimal(double value) {
  char text[32];
  // 15 significant digits survive a round trip from text, so most numbers of people come back as they were
  // written (100000, where the shortest form of all would be 1e+05).
  const std::to_chars_result plain = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 15);
  double back = 0.0;
  std::from_chars(text, plain.ptr, back);
  if (back == value) return std::string(text, plain.ptr);
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace strict_config
