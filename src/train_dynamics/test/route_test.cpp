// Routes: what lists and points give at each position, against the definition; the rules between them.
#include "train_dynamics/track/route.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/track/track.h"

namespace train_dynamics {
namespace {

std::string RefusalOf(const TrackParams& params) {
  try {
    const Track track(params);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

RoutePointParams At(double position_m) {
  RoutePointParams point;
  point.position_m = position_m;
  return point;
}

TEST(Curves, AreStraightOutsideOfTheirStretches) {
  TrackParams params;
  params.curves = {{100.0, 200.0, 400.0}, {200.0, 350.0, -500.0}, {600.0, 601.0, 50.0}};
  const Track track(params);
  EXPECT_TRUE(track.has_curves);
  EXPECT_EQ(CurvatureAt(track, -1e7), 0.0);
  EXPECT_EQ(CurvatureAt(track, std::nextafter(100.0, 0.0)), 0.0);
  EXPECT_EQ(CurvatureAt(track, 100.0), 1.0 / 400.0);
  EXPECT_EQ(CurvatureAt(track, std::nextafter(200.0, 0.0)), 1.0 / 400.0);
  EXPECT_EQ(CurvatureAt(track, 200.0), -1.0 / 500.0);
  EXPECT_EQ(CurvatureAt(track, 350.0), 0.0);
  EXPECT_EQ(CurvatureAt(track, 600.5), 1.0 / 50.0);
  EXPECT_EQ(CurvatureAt(track, 601.0), 0.0);
  EXPECT_EQ(CurvatureAt(track, 1e7), 0.0);
  EXPECT_FALSE(Track().has_curves);
}

TEST(Curves, OverLanesAreThoseOfEachPosition) {
  TrackParams params;
  params.curves = {{100.0, 200.0, 400.0}, {300.0, 350.0, -500.0}};
  const Track track(params);
  using Pack = Lanes<4>;
  const double at[] = {50.0, 150.0, 300.0, 349.0};
  const Pack curvature = CurvatureUnder(track, Pack::Load(at));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(curvature[i], CurvatureAt(track, at[i])) << at[i];
}

TEST(Curves, TheirAngleIsThatOfTheirLengthWhereverTheyMeet) {
  // The integral of |1/R| over a route is the sum of the angles, however the curves follow each other.
  TrackParams params;
  double angle = 0.0, at_m = -3000.0;
  for (int i = 0; i < 40; ++i) {
    const double length_m = 10.0 + 7.0 * i, radius_m = (i % 2 == 0 ? 1.0 : -1.0) * (200.0 + 50.0 * i);
    params.curves.push_back({at_m, at_m + length_m, radius_m});
    angle += length_m / std::abs(radius_m);
    at_m += length_m + (i % 3 == 0 ? 0.0 : 40.0);
  }
  const Track track(params);
  double sum = 0.0;
  constexpr double kStep = 0.01;
  for (double x = -3100.0; x < at_m + 100.0; x += kStep) sum += kStep * std::abs(CurvatureAt(track, x));
  EXPECT_NEAR(sum, angle, 1e-3 * angle);
}

TEST(Curves, ThatCannotBeAreRefused) {
  TrackParams params;
  params.curves = {{0.0, 100.0, 49.0}};
  EXPECT_NE(RefusalOf(params).find("radius_m must be at least 50 m"), std::string::npos) << RefusalOf(params);
  params.curves = {{0.0, 100.0, -400.0}, {99.0, 120.0, 300.0}};
  EXPECT_NE(RefusalOf(params).find("curves[1].from_m must be at least to_m of the entry before, 100"),
            std::string::npos)
      << RefusalOf(params);
  params.curves = {{100.0, 100.0, -400.0}};
  EXPECT_NE(RefusalOf(params).find("to_m must be greater than from_m"), std::string::npos) << RefusalOf(params);
}

TEST(Heights, MakeTheGradesBetweenThem) {
  TrackParams params;
  params.heights = {{0.0, 100.0}, {250.0, 102.5}, {1000.0, 95.0}};
  const Track track(params);
  EXPECT_EQ(GradeAt(track, -1e5), 0.0);
  EXPECT_EQ(GradeAt(track, -0.25), 0.0);
  EXPECT_DOUBLE_EQ(GradeAt(track, 0.0), 0.01);
  EXPECT_DOUBLE_EQ(GradeAt(track, 249.0), 0.01);
  EXPECT_DOUBLE_EQ(GradeAt(track, 250.0), -0.01);
  EXPECT_EQ(GradeAt(track, 1000.0), 0.0);
  params.heights[2].height_m = -60.0;  // -162.5 m on 750 m: steeper than 20 %
  EXPECT_NE(RefusalOf(params).find("heights[2].height_m must not make a grade steeper than 20 %"), std::string::npos)
      << RefusalOf(params);
}

TEST(Points, GiveWhatTheListsGive) {
  TrackParams lists;
  lists.grades = {{0.0, 0.5}, {500.0, -1.0}};
  lists.curves = {{250.0, 750.0, 400.0}};
  lists.speed_limits = {{0.0, 80.0}, {750.0, 60.0}};
  lists.stations = {{"Aadorf", 0.0}, {"Zell", 750.0}};
  TrackParams table;
  table.points = {At(0.0), At(250.0), At(500.0), At(750.0)};
  table.points[0].grade_permille = 5.0;
  table.points[0].radius_m = 0.0;
  table.points[0].speed_limit_kmh = 80.0;
  table.points[0].station = "Aadorf";
  table.points[1].radius_m = 400.0;
  table.points[2].grade_percent = -1.0;
  table.points[3] = RoutePointParams();
  table.points[3].position_km = 0.75;
  table.points[3].radius_m = 0.0;
  table.points[3].speed_limit_kmh = 60.0;
  table.points[3].station = "Zell";
  const Track one(lists), other(table);
  for (double x = -1000.0; x < 2000.0; x += 12.5) {
    EXPECT_DOUBLE_EQ(GradeAt(one, x), GradeAt(other, x)) << x;
    EXPECT_EQ(CurvatureAt(one, x), CurvatureAt(other, x)) << x;
    EXPECT_EQ(one.speed_limits().At(x), other.speed_limits().At(x)) << x;
  }
  const std::vector<StationParams> stations = table.Stations();
  ASSERT_EQ(stations.size(), 2U);
  EXPECT_EQ(stations[1].name, "Zell");
  EXPECT_EQ(stations[1].position_m, 750.0);
}

TEST(Points, HoldTheirFrictionToTheNext) {
  TrackParams params;
  params.points = {At(0.0), At(100.0)};
  params.points[0].friction_coefficient = 0.3;
  params.points[1].friction_coefficient = 0.1;
  const Track track(params);
  const AdhesionParams own;
  EXPECT_EQ(track.SurfaceFrom(-50.0, own).friction, 0.3);
  EXPECT_EQ(track.SurfaceFrom(99.0, own).friction, 0.3);
  EXPECT_EQ(track.SurfaceFrom(100.0, own).friction, 0.1);
  EXPECT_EQ(track.SurfaceFrom(5e4, own).friction, 0.1);
}

TEST(Points, DoNotSayTwiceWhatTheListsSay) {
  TrackParams params;
  params.points = {At(0.0), At(10.0)};
  params.points[1].grade_permille = 1.0;
  params.grades = {{0.0, 0.1}};
  EXPECT_NE(RefusalOf(params).find("points[1].grade_permille must not stand beside grades"), std::string::npos)
      << RefusalOf(params);
  params.grades.clear();
  params.points[0].height_m = 10.0;
  EXPECT_NE(RefusalOf(params).find("points[0].height_m must not stand beside"), std::string::npos) << RefusalOf(params);
  params.points[0] = RoutePointParams();
  EXPECT_NE(RefusalOf(params).find("position_m or position_km must be given"), std::string::npos) << RefusalOf(params);
  params.points = {At(10.0), At(10.0)};
  EXPECT_NE(RefusalOf(params).find("points[1].position_m must lie behind that of the entry before, at 10 m"),
            std::string::npos)
      << RefusalOf(params);
}

TEST(SpeedLimits, TheLowestUnderTheTrainHolds) {
  TrackParams params;
  params.speed_limits = {{0.0, 90.0}, {1000.0, 36.0}, {1200.0, 72.0}};
  const Track track(params);
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 0.0, 999.0), 25.0);
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 200.0, 1000.0), 10.0);
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 500.0, 2000.0), 10.0);  // longer than the slow stretch
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 1199.0, 1900.0), 10.0);
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 1200.0, 1900.0), 20.0);
  EXPECT_DOUBLE_EQ(SpeedLimitUnder(track, 1900.0, 1100.0), 10.0);  // a train that runs backwards
  EXPECT_EQ(SpeedLimitUnder(Track(), 0.0, 10.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace train_dynamics
