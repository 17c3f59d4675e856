#include "train_dynamics/track/grade.h"

#include <gtest/gtest.h>

#include "strict_config/validate.h"
#include "train_dynamics/track/track.h"

namespace train_dynamics {
namespace {

TEST(Grade, HoldsFromItsEntryToTheNext) {
  TrackParams track;
  EXPECT_EQ(GradeAt(track, 123.0), 0.0);
  track.grades = {{0.0, -0.5}, {100.0, 0.0}, {250.0, 1.5}};
  EXPECT_EQ(GradeAt(track, -1e6), -0.005);  // the first also holds before it
  EXPECT_EQ(GradeAt(track, 0.0), -0.005);
  EXPECT_EQ(GradeAt(track, 99.999), -0.005);
  EXPECT_EQ(GradeAt(track, 100.0), 0.0);
  EXPECT_EQ(GradeAt(track, 250.0), 0.015);
  EXPECT_EQ(GradeAt(track, 1e9), 0.015);
  EXPECT_EQ(GradeUnder<double>(track, 180.0), 0.0);
  track.grades = {{100.0, 2.0}};
  EXPECT_EQ(GradeUnder<double>(track, -5.0), 0.02);
}

TEST(Grade, EntriesMustAscend) {
  TrackParams track;
  track.grades = {{0.0, 1.0}, {0.0, 2.0}};
  EXPECT_THROW(strict_config::Validate(track), std::invalid_argument);
}

}  // namespace
}  // namespace train_dynamics
