#include "train_brake_rviz/board/close_up.h"

#include <gtest/gtest.h>

#include "area.h"
#include "train_dynamics/config/load_scenario.h"

namespace train_brake_rviz {
namespace {

using train_dynamics::kCarbody;
using train_dynamics::kWheelset1;

constexpr Rectangle kArea = {4.0, 112.0, 0.5, 25.0};
constexpr double kExaggeration = 10.0;

class CloseUpTest : public testing::Test {
 protected:
  CloseUpTest()
      : vehicle_(train_dynamics::config::LoadVehicle(TRAIN_BRAKE_CONFIG_DIR "/vehicles/ore_wagon.yaml", {})),
        wagon_at_rest_(train_dynamics::StaticEquilibrium(train_dynamics::Wagon(vehicle_), 0.0, 0.0).position),
        at_rest_(CloseUp::BodiesOf(wagon_at_rest_)),
        close_up_(kArea, vehicle_, at_rest_, kExaggeration) {}

  Drawing Draw(const train_dynamics::WagonDetail* detail, double front_force_n = 0.0) const {
    Drawing drawing;
    CloseUp::Sight sight{};
    sight.centre_m = 100.0;
    sight.detail = detail;
    sight.front_force_n = front_force_n;
    sight.color = palette::kPaper;
    close_up_.Draw(drawing, {}, sight);
    return drawing;
  }

  train_dynamics::VehicleParams vehicle_;
  train_dynamics::BodyVector<double> wagon_at_rest_;
  CloseUp::Bodies at_rest_;
  CloseUp close_up_;
};

TEST_F(CloseUpTest, AtRestTheWheelsStandOnTheRail) {
  const double radius = vehicle_.wheelset.wheel_radius_m;
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(close_up_.rail(), close_up_.PlaceOf(at_rest_, kWheelset1 + i, 0.0, -radius).up, 1e-9);
  }
}

TEST_F(CloseUpTest, ProportionsAreThoseOfTheWagonAndTheFrontIsOnTheLeft) {
  const Point first = close_up_.PlaceOf(at_rest_, kWheelset1, 0.0, 0.0);
  const Point last = close_up_.PlaceOf(at_rest_, kWheelset1 + 3, 0.0, 0.0);
  const double wheelbase = 2.0 * (vehicle_.half_bogie_spacing_m + vehicle_.half_wheelset_spacing_m);
  EXPECT_NEAR(wheelbase * close_up_.scale(), last.right - first.right, 1e-9);
  EXPECT_NEAR(kArea.left + kArea.right, first.right + last.right, 1e-9);
}

TEST_F(CloseUpTest, WheelsTurnAsFarAsTheyRoll) {
  const double radius = vehicle_.wheelset.wheel_radius_m;
  CloseUp::Bodies rolled = at_rest_;
  rolled.pitch[kWheelset1] += M_PI / 2.0;  // a quarter forward: what was on top is in front
  const Point axle = close_up_.PlaceOf(rolled, kWheelset1, 0.0, 0.0);
  const Point mark = close_up_.PlaceOf(rolled, kWheelset1, 0.0, radius);
  EXPECT_NEAR(axle.right - close_up_.scale() * radius, mark.right, 1e-9);
  EXPECT_NEAR(axle.up, mark.up, 1e-9);
}

TEST_F(CloseUpTest, MotionAgainstRestIsExaggerated) {
  CloseUp::Bodies moved = at_rest_;
  moved.z[kCarbody] -= 0.01;
  moved.pitch[kCarbody] += 0.002;  // nose down
  const Point before = close_up_.PlaceOf(at_rest_, kCarbody, 0.0, 0.0);
  const Point centre = close_up_.PlaceOf(moved, kCarbody, 0.0, 0.0);
  EXPECT_NEAR(-0.01 * kExaggeration * close_up_.scale(), centre.up - before.up, 1e-9);
  EXPECT_LT(close_up_.PlaceOf(moved, kCarbody, 3.0, 0.0).up, close_up_.PlaceOf(moved, kCarbody, -3.0, 0.0).up);

  CloseUp::Bodies travelled = at_rest_;
  for (double& x : travelled.x) x += 1234.5;  // the whole wagon: nothing moves against anything
  EXPECT_NEAR(before.right, close_up_.PlaceOf(travelled, kCarbody, 0.0, 0.0).right, 1e-9);
}

TEST_F(CloseUpTest, ArrowsAreAsLongAsTheForcesAreLarge) {
  train_dynamics::WagonDetail detail;
  detail.position = wagon_at_rest_;
  detail.output.normal_force_n = {390e3, 390e3, 390e3, 390e3};
  detail.output.creep_force_n = {0.0, 0.0, 0.0, 20e3};
  const Drawing drawing = Draw(&detail);
  const Rectangle load = ExtentOf(drawing, palette::kGreen);
  EXPECT_NEAR(390e3 * CloseUp::kLoadScale, load.height(), 1e-9);
  EXPECT_NEAR(close_up_.rail(), load.top, 1e-9);  // pushes upwards, up to the rail
  const Rectangle creep = ExtentOf(drawing, palette::kOrange);
  EXPECT_NEAR(20e3 * CloseUp::kFrictionScale, creep.width(), 1e-9);
  EXPECT_NEAR(close_up_.PlaceOf(at_rest_, kWheelset1 + 3, 0.0, 0.0).right, creep.left, 1e-9);  // backwards
}

TEST_F(CloseUpTest, CouplersPullOutwardsAndPushInwards) {
  const double end = close_up_.PlaceOf(at_rest_, kCarbody, 0.5 * vehicle_.length_m, 0.0).right;
  const Rectangle pull = ExtentOf(Draw(nullptr, 300e3), palette::kTension);
  EXPECT_NEAR(300e3 * CloseUp::kCouplerScale, pull.width(), 1e-9);
  EXPECT_LT(pull.right, end);
  const Rectangle push = ExtentOf(Draw(nullptr, -300e3), palette::kCompression);
  EXPECT_NEAR(pull.left, push.left, 1e-9);
  EXPECT_NEAR(pull.right, push.right, 1e-9);
}

TEST_F(CloseUpTest, ASlidingWheelIsSeenAtOnce) {
  train_dynamics::WagonDetail detail;
  detail.position = wagon_at_rest_;
  EXPECT_EQ(0.0, AreaOf(Draw(&detail), palette::kVermillion));
  detail.output.creepage[2] = 1.0;  // locked
  const Rectangle wheel = ExtentOf(Draw(&detail), palette::kVermillion);
  EXPECT_NEAR(2.0 * vehicle_.wheelset.wheel_radius_m * close_up_.scale(), wheel.width(), 1e-9);
}

TEST_F(CloseUpTest, ALockedWheelIsWrittenOut) {
  train_dynamics::WagonDetail detail;
  detail.position = wagon_at_rest_;
  const auto says = [this](const train_dynamics::WagonDetail& of) {
    int locked = 0;
    const Drawing drawing = Draw(&of);
    for (const auto& text : drawing.texts()) locked += text.words == "LOCKED" ? 1 : 0;
    return locked;
  };
  detail.output.creepage[2] = 0.99;
  detail.velocity.x[kWheelset1 + 2] = 10.0;
  EXPECT_EQ(1, says(detail));
  detail.output.creepage[2] = 0.97;  // it turns a little
  EXPECT_EQ(0, says(detail));
  detail.output.creepage[2] = 0.99;
  detail.velocity.x[kWheelset1 + 2] = 0.5;  // near standstill
  EXPECT_EQ(0, says(detail));
}

}  // namespace
}  // namespace train_brake_rviz
