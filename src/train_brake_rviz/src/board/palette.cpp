#include "train_brake_rviz/board/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace train_brake_rviz {
namespace {

template <size_t n>
Color Between(const std::array<Color, n>& colors, double place) {
  if (!std::isfinite(place)) return palette::kAxis;
  const double at = std::clamp(place, 0.0, 1.0) * (n - 1);
  const size_t i = std::min(static_cast<size_t>(at), n - 2);
  const float share = static_cast<float>(at - static_cast<double>(i));
  const auto mix = [share](float a, float b) { return a + share * (b - a); };
  const Color &a = colors[i], &b = colors[i + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace

Color Diverging(double value) {
  static constexpr std::array<Color, 11> kColors = {
      Rgb(0x67001f), Rgb(0xb2182b), Rgb(0xd6604d), Rgb(0xf4a582), Rgb(0xfddbc7), Rgb(0xf7f7f7),
      Rgb(0xd1e5f0), Rgb(0x92c5de), Rgb(0x4393c3), Rgb(0x2166ac), Rgb(0x053061)};
  return Between(kColors, 0.5 * (value + 1.0));
}

Color Sequential(double value) {
  static constexpr std::array<Color, 9> kColors = {Rgb(0xfde725), Rgb(0xaddc30), Rgb(0x5ec962),
                                                   Rgb(0x28ae80), Rgb(0x21918c), Rgb(0x2c728e),
                                                   Rgb(0x3b528b), Rgb(0x472d7b), Rgb(0x440154)};
  return Between(kColors, value);
}

}  // namespace train_brake_rviz
