#include "train_brake_rviz/board/elevation.h"

#include <gtest/gtest.h>

namespace train_brake_rviz {
namespace {

using train_dynamics::TrackParams;

TrackParams Hills() {
  TrackParams track;
  track.grades = {{-500.0, 0.8}, {100.0, -1.2}, {900.0, 0.3}};
  track.dips = {{40.0, 0.05, 10.0}};
  return track;
}

TEST(Elevation, RisesAsTheGradeAndTheDipsSay) {
  const TrackParams track = Hills();
  const Elevation elevation(track);
  constexpr double kStep = 1e-3;
  for (double s = -900.0; s < 1500.0; s += 3.7) {  // never on a change of grade
    const double slope = (elevation(s + kStep) - elevation(s - kStep)) / (2.0 * kStep);
    const double expected = train_dynamics::GradeAt(track, s) + train_dynamics::RailHeightAt(track, s).slope;
    EXPECT_NEAR(expected, slope, 1e-6) << s;  // the dip's third derivative times the step squared
  }
}

TEST(Elevation, IsZeroAtZeroAndWithoutGaps) {
  const Elevation elevation(Hills());
  EXPECT_NEAR(0.0, elevation(0.0), 1e-12);
  for (const double change : {-500.0, 100.0, 900.0, 40.0, 50.0}) {
    EXPECT_NEAR(elevation(change - 1e-9), elevation(change + 1e-9), 1e-9);
  }
  EXPECT_NEAR(-0.05 + 0.008 * 45.0, elevation(45.0), 1e-12);  // the bottom of the dip, on the first grade
  EXPECT_EQ(0.0, Elevation(TrackParams())(1234.0));
}

TEST(FittingExaggeration, IsTheLargestThatFits) {
  const double scale = 0.06, window = 2500.0;
  for (const double grade_percent : {0.1, 0.5, 1.0, 2.5}) {
    TrackParams track;
    track.grades = {{0.0, -grade_percent}};
    const double range = 0.01 * grade_percent * window * scale;  // drawn without exaggeration
    const double room = 13.0 * range;
    EXPECT_EQ(10.0, FittingExaggeration(Elevation(track), 0.0, 3000.0, window, scale, room));
  }
  EXPECT_EQ(100.0, FittingExaggeration(Elevation(TrackParams()), 0.0, 3000.0, window, scale, 5.0));
}

TEST(FittingExaggeration, SeesADipThatIsStillFarAhead) {
  TrackParams track;
  track.dips = {{800.0, 0.1, 20.0}};
  EXPECT_EQ(20.0, FittingExaggeration(Elevation(track), 0.0, 1000.0, 100.0, 1.0, 3.0));
}

}  // namespace
}  // namespace train_brake_rviz
