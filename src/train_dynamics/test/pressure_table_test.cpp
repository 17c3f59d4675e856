#include "train_dynamics/brake/pressure_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "strict_config/validate.h"
#include "train_dynamics/brake/air_brake.h"
#include "train_dynamics/brake/brake_system.h"

namespace train_dynamics {
namespace {

TEST(PressureTable, IsLinearBetweenRowsAndHoldsItsEnds) {
  const PressureTable table({1.0, 2.0, 4.0}, {{0.0, 100.0, 300.0}, {50.0, 0.0, 10.0}});
  ASSERT_EQ(table.vehicles(), 2);
  std::vector<double> p;
  const auto expect = [&](double time, double first, double second) {
    table.PressuresAt(time, p);
    EXPECT_EQ(p, (std::vector<double>{first, second})) << time;
  };
  expect(-5.0, 0.0, 50.0);
  expect(1.0, 0.0, 50.0);
  expect(1.25, 25.0, 37.5);
  expect(2.0, 100.0, 0.0);
  expect(3.5, 250.0, 7.5);
  expect(4.0, 300.0, 10.0);
  expect(1e9, 300.0, 10.0);
  PressureTable({0.0}, {{7.0}}).PressuresAt(3.0, p);
  EXPECT_EQ(p, std::vector<double>{7.0});
}

TEST(PressureTable, WrongTablesAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(PressureTable({}, {}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, 0.0}, {{1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({1.0, 0.0}, {{1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, 1.0}, {{1.0}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, 1.0}, {{1.0, -2.0}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, 1.0}, {{1.0, nan}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, 1.0}, {{1.0, infinity}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({0.0, nan}, {{1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(PressureTable({nan}, {{1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace train_dynamics
