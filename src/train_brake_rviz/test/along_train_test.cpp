#include "train_brake_rviz/board/along_train.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "area.h"
#include "train_brake_rviz/board/quantity.h"

namespace train_brake_rviz {
namespace {

TEST(Abscissa, PutsTheFrontOnTheLeft) {
  const Abscissa abscissa = {120.0, 14.0, 0.5};
  EXPECT_DOUBLE_EQ(14.0, abscissa(120.0));
  EXPECT_DOUBLE_EQ(24.0, abscissa(100.0));
}

TEST(VehicleEdges, TilesTheTrain) {
  const std::vector<double> centre = {-5.0, -15.2, -25.0, -35.1};
  const std::vector<double> edges = VehicleEdges(centre, 10.0, 10.0);
  ASSERT_EQ(5u, edges.size());
  EXPECT_DOUBLE_EQ(0.0, edges.front());
  EXPECT_DOUBLE_EQ(-40.1, edges.back());
  for (size_t i = 0; i < centre.size(); ++i) {
    EXPECT_GT(edges[i], centre[i]);
    EXPECT_LT(edges[i + 1], centre[i]);
  }
}

TEST(AlongPlot, TheAreaOfTheBarsIsTheIntegralOfTheValues) {
  const Rectangle area = {14.0, 114.0, 20.0, 40.0};
  const Axis values = {-50.0, 50.0, area.bottom, area.top};
  const Abscissa abscissa = {0.0, area.left, 2.0};
  const std::vector<double> edge = {0.0, -10.0, -21.0, -30.0};
  const std::vector<double> value = {12.0, 40.0, 5.0}, zero(3, 0.0);
  Drawing drawing;
  AlongPlot(area, values, abscissa).DrawBars(drawing, edge, zero, value, palette::kBlue);
  const double integral = 12.0 * 10.0 + 40.0 * 11.0 + 5.0 * 9.0;
  const double per_unit = 2.0 * area.height() / 100.0;
  EXPECT_NEAR(integral * per_unit, AreaOf(drawing, palette::kBlue), 1e-9);
}

TEST(AlongPlot, BarsStayInThePlotAndWhatIsUnknownIsLeftOut) {
  const Rectangle area = {14.0, 114.0, 20.0, 40.0};
  const AlongPlot plot(area, {0.0, 50.0, area.bottom, area.top}, {0.0, area.left, 2.0});
  Drawing drawing;
  plot.DrawBars(drawing, {0.0, -10.0, -20.0, -30.0}, {0.0, 0.0, 0.0},
                {1e6, std::numeric_limits<double>::quiet_NaN(), -3.0}, palette::kBlue);
  EXPECT_EQ(6u, drawing.vertices().size());  // one bar
  EXPECT_DOUBLE_EQ(area.top, ExtentOf(drawing, palette::kBlue).top);
}

TEST(VehicleCouplerForces, TakeTheLargerOfTheTwo) {
  Snapshot snapshot;
  snapshot.position_m = {0.0, -10.0, -20.0, -30.0};
  snapshot.coupler_force_n = {5.0, -8.0, 2.0};
  EXPECT_EQ((std::vector<double>{5.0, -8.0, -8.0, 2.0}), VehicleCouplerForces(snapshot));
  snapshot.coupler_force_n.clear();  // not recorded
  EXPECT_TRUE(VehicleCouplerForces(snapshot).empty());
}

}  // namespace
}  // namespace train_brake_rviz
