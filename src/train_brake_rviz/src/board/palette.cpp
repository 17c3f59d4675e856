#include "train_brake_rviz/board/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace train_brake_rviz {
namespace {

template <size_t n>
Color Between(const std::array<Color, n>& colors, double place) {
  if (!std::isfinite(place)) return palette::kUnknown;
  const double at = std::clamp(place, 0.0, 1.0) * (n - 1);
  const size_t i = std::min(static_cast<size_t>(at), n - 2);
  const float share = static_cast<float>(at - static_cast<double>(i));
  const auto mix = [share](float a, float b) { return a + share * (b - a); };
  const Color &a = colors[i], &b = colors[i + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace

Color Diverging(double value) {
  static constexpr std::array<Color, 7> kColors = {Rgb(0x00304b), palette::kBlue,       Rgb(0x9fd0ea), Rgb(0xf7f7f7),
                                                   Rgb(0xf6b98c), palette::kVermillion, Rgb(0x5f2a00)};
  return Between(kColors, 0.5 * (value + 1.0));
}

Color Sequential(double value) {
  static constexpr std::array<Color, 4> kColors = {Rgb(0xf7f7f7), Rgb(0x9fd0ea), palette::kBlue, Rgb(0x00304b)};
  return Between(kColors, value);
}

}  // namespace train_brake_rviz
