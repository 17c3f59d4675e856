#pragma once

namespace train_brake_rviz {

struct Color {
  float red, green, blue;  ///< 0 ... 1
};

constexpr Color Rgb(unsigned hex) {
  return {static_cast<float>(hex >> 16 & 0xff) / 255.0f, static_cast<float>(hex >> 8 & 0xff) / 255.0f,
          static_cast<float>(hex & 0xff) / 255.0f};
}

/// Colours of things: those of Okabe and Ito, which every kind of colour vision can distinguish, and greys. The report
/// (train_brake_report/style.py) has the same ones.
namespace palette {
inline constexpr Color kOrange = Rgb(0xe69f00), kSkyBlue = Rgb(0x56b4e9), kGreen = Rgb(0x009e73), kBlue = Rgb(0x0072b2),
                       kVermillion = Rgb(0xd55e00), kPurple = Rgb(0xcc79a7);
inline constexpr Color kInk = Rgb(0x1b1f24), kDark = Rgb(0x59636e), kAxis = Rgb(0x8a949e), kGrid = Rgb(0xd8dde3),
                       kShade = Rgb(0xeceff2), kPaper = Rgb(0xffffff), kUnknown = Rgb(0x999999);

inline constexpr Color kTension = kVermillion, kCompression = kBlue;
}  // namespace palette

/// Colours of values. Each scale is even in lightness and readable with any colour vision; values outside
/// take the colour of the nearer end, and what is not a number is grey.

/// -1 (blue, dark) ... 0 (nearly white) ... 1 (red, dark).
Color Diverging(double value);

/// 0 (nearly white) ... 1 (blue, dark).
Color Sequential(double value);

}  // namespace train_brake_rviz
