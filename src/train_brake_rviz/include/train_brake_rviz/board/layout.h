#pragma once

#include "train_brake_rviz/board/drawing.h"

/// Where things are on the board, from top to bottom: numbers, two plots, the train, a wagon close up beside
/// the legends.
namespace train_brake_rviz::layout {

inline constexpr Rectangle kBoard = {0.0, 168.0, 0.0, 84.0};

inline constexpr double kLeft = 14.0, kRight = 164.0;  ///< of the plots and of the train between them
inline constexpr Rectangle kHeader = {4.0, kRight, 76.0, 83.0};
inline constexpr Rectangle kForcePlot = {kLeft, kRight, 57.0, 71.5};
inline constexpr Rectangle kPressurePlot = {kLeft, kRight, 43.5, 53.0};
inline constexpr Rectangle kTrain = {kLeft, kRight, 27.5, 38.8};
inline constexpr Rectangle kCloseUp = {4.0, 112.0, 0.5, 25.0};
inline constexpr Rectangle kLegend = {120.0, kRight, 0.5, 25.0};

inline constexpr double kText = 2.3, kSmallText = 1.9, kLargeText = 4.2;  ///< heights of lines
inline constexpr double kThin = 0.12, kThick = 0.3;                       ///< widths of lines

}  // namespace train_brake_rviz::layout
