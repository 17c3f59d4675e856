#include "train_brake_rviz/board/board.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "area.h"
#include "train_brake_rviz/board/layout.h"
#include "train_dynamics/config/load_scenario.h"

namespace train_brake_rviz {
namespace {

using train_dynamics::ScenarioParams;

ScenarioParams Load(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return train_dynamics::config::LoadScenario(TRAIN_BRAKE_CONFIG_DIR "/scenarios/" + name + ".yaml", overrides).params;
}

/// A train that has come `travelled_m` far, with forces up to this size.
Snapshot Travelled(const ScenarioParams& scenario, double travelled_m, double force_n) {
  const train_dynamics::Consist consist(scenario.train);
  const auto n = static_cast<size_t>(consist.vehicles());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> size(-1.0, 1.0);
  Snapshot snapshot;
  snapshot.time_s = 59.99;
  snapshot.real_time_factor = 12.34;
  for (const double centre : consist.centre_m) {
    snapshot.position_m.push_back(scenario.start_position_m + travelled_m + centre);
    snapshot.speed_mps.push_back(22.0);
    snapshot.acceleration_mps2.push_back(size(random));
    snapshot.creepage.push_back(size(random));
    snapshot.cylinder_pressure_pa.push_back(4e5 * std::abs(size(random)));
  }
  for (size_t c = 0; c + 1 < n; ++c) snapshot.coupler_force_n.push_back(force_n * size(random));
  return snapshot;
}

std::vector<const Drawing*> PartsOf(const Picture& p) {
  return {&p.numbers, &p.plots, &p.train, &p.close_up, &p.legend};
}

bool Overlap(const Rectangle& a, const Rectangle& b) {
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

void ExpectWithin(const Rectangle& inner, const Rectangle& outer, const std::string& what) {
  EXPECT_GE(inner.left, outer.left) << what;
  EXPECT_LE(inner.right, outer.right) << what;
  EXPECT_GE(inner.bottom, outer.bottom) << what;
  EXPECT_LE(inner.top, outer.top) << what;
}

struct Case {
  std::string scenario;
  std::vector<std::string> overrides;
  double travelled_m, force_n;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.scenario << " at " << c.travelled_m << " m"; }

class BoardPicture : public testing::TestWithParam<Case> {};

TEST_P(BoardPicture, IsWithinTheBoardAndNoTextLiesOnAnother) {
  const ScenarioParams scenario = Load(GetParam().scenario, GetParam().overrides);
  Board board(scenario);
  for (const Quantity& quantity : Quantities()) {
    for (const int vehicle : {0, board.vehicles() / 2, board.vehicles() - 1}) {
      const Picture picture =
          board.Draw(Travelled(scenario, GetParam().travelled_m, GetParam().force_n), {&quantity, vehicle});
      std::vector<const Text*> texts;
      for (const Drawing* part : PartsOf(picture)) {
        for (const Vertex& vertex : part->vertices()) {
          ExpectWithin({vertex.at.right, vertex.at.right, vertex.at.up, vertex.at.up}, layout::kBoard, "shape");
        }
        for (const Text& text : part->texts()) {
          ExpectWithin(ExtentOf(text), layout::kBoard, text.words);
          for (const Text* other : texts) {
            EXPECT_FALSE(Overlap(ExtentOf(text), ExtentOf(*other))) << text.words << " | " << other->words;
          }
          texts.push_back(&text);
        }
      }
      EXPECT_GT(texts.size(), 25u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, BoardPicture,
                         testing::Values(Case{"emergency", {}, 0.0, 0.0}, Case{"emergency", {}, 1234.0, 2.5e6},
                                         Case{"emergency", {"model=ltd"}, 321.0, 9e5}, Case{"minimum", {}, 777.0, 3e5},
                                         Case{"dip", {}, 45.0, 0.0}, Case{"ore_line_trip", {}, 30000.0, 1e6},
                                         Case{"emergency",
                                              {"train.consist=[{vehicle: ore_wagon, count: 3}]", "detail_vehicles=[1]",
                                               "brake=single_vehicle"},
                                              10.0,
                                              1e5}));

TEST(Board, ColoursEachVehicleByItsValue) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 0.0, 0.0);
  snapshot.cylinder_pressure_pa.assign(242, 4e5);
  snapshot.cylinder_pressure_pa[41] = 1.5e5;
  snapshot.cylinder_pressure_pa[222] = 9e5;  // hardly any vehicle: does not move the scale's end
  Board board(scenario);
  const Quantity& pressure = *FindQuantity("pressure");
  const Picture picture = board.Draw(snapshot, {&pressure, 0});
  const Rectangle vehicle = ExtentOf(picture.train, ColorOf(pressure, 150.0, 500.0));  // kPa; the scale's end
  const double scale = layout::kTrain.width() / (1.012 * 242.0 * 10.5);
  EXPECT_NEAR(0.92 * 10.5 * scale, vehicle.width(), 1e-6);  // with a gap of 8 %
  const double middle = 0.5 * (vehicle.left + vehicle.right);
  EXPECT_NEAR(41.5 / 242.0, (middle - layout::kTrain.left) / layout::kTrain.width(),
              0.006);  // of the train's length
}

// A pipe that falls towards the rear, of a brake that has one: each vehicle has the colour of its pressure.
TEST(Board, ShowsThePipeAlongTheTrain) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 0.0, 0.0);
  Board board(scenario);
  const Quantity& pipe = *FindQuantity("pipe_pressure");
  const Color front = ColorOf(pipe, 450.0, 500.0), rear = ColorOf(pipe, 300.0, 500.0);  // kPa; the scale's end
  EXPECT_EQ(0.0, AreaOf(board.Draw(snapshot, {&pipe, 0}).train, front));                // the brake has none
  snapshot.pipe_pressure_pa.assign(242, 4.5e5);
  for (int i = 121; i < 242; ++i) snapshot.pipe_pressure_pa[i] = 3.0e5;
  const Picture picture = board.Draw(snapshot, {&pipe, 0});
  EXPECT_NEAR(AreaOf(picture.train, front) / AreaOf(picture.train, rear), 1.0, 1e-6);
  EXPECT_LT(ExtentOf(picture.train, front).right, ExtentOf(picture.train, rear).left);
}

TEST(Board, PlotsOfForcesAreTrueToScale) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 0.0, 0.0);
  snapshot.coupler_force_n.assign(241, 0.0);
  snapshot.coupler_force_n[100] = 150e3;
  snapshot.coupler_force_n[200] = -80e3;
  Board board(scenario);
  const Drawing plots = board.Draw(snapshot, {}).plots;
  const Rectangle &area = layout::kForcePlot, tension = ExtentOf(plots, palette::kTension),
                  compression = ExtentOf(plots, palette::kCompression);
  const double zero = 0.5 * (area.bottom + area.top),
               per_kn = 0.5 * area.height() / 200.0;  // from -200 to 200 kN
  EXPECT_NEAR(zero, tension.bottom, 1e-9);
  EXPECT_NEAR(zero + 150.0 * per_kn, tension.top, 1e-9);
  EXPECT_NEAR(zero - 80.0 * per_kn, compression.bottom, 1e-9);
  EXPECT_LT(tension.right, compression.left);
}

TEST(Board, RemembersTheRangeUntilItIsToldToForget) {
  const ScenarioParams scenario = Load("emergency");
  const auto grey = [](const Picture& picture) { return AreaOf(picture.plots, palette::kShade); };
  Board board(scenario);
  EXPECT_GT(grey(board.Draw(Travelled(scenario, 0.0, 9e5), {})), 100.0);
  Snapshot quiet = Travelled(scenario, 0.0, 0.0);
  quiet.cylinder_pressure_pa.assign(242, 0.0);
  EXPECT_GT(grey(board.Draw(quiet, {})), 100.0);
  board.Forget();
  EXPECT_EQ(0.0, grey(board.Draw(quiet, {})));
}

TEST(Board, DrawsWhatIsThereOfAnIncompleteRecord) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 10.0, 1e5);
  snapshot.coupler_force_n.clear();
  snapshot.cylinder_pressure_pa.clear();
  snapshot.creepage.assign(242, std::numeric_limits<double>::quiet_NaN());  // an LTD run
  snapshot.acceleration_mps2.clear();
  Board board(scenario);
  for (const Quantity& quantity : Quantities()) {
    const Picture picture = board.Draw(snapshot, {&quantity, 5});
    for (const Drawing* part : PartsOf(picture)) {
      for (const Vertex& vertex : part->vertices()) {
        ASSERT_TRUE(std::isfinite(vertex.at.right) && std::isfinite(vertex.at.up));
      }
    }
  }
  EXPECT_TRUE(board.Draw({}, {}).train.vertices().empty());
}

TEST(Board, WritesADashForWhatIsNotKnown) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 10.0, 1e5);
  Board board(scenario);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  snapshot.wagon.emplace();  // as before the first exchange: where the bodies are, but no forces
  snapshot.wagon->output.normal_force_n.fill(kUnknown);
  snapshot.wagon->output.creep_force_n.fill(kUnknown);
  snapshot.wagon->output.shoe_force_n.fill(kUnknown);
  snapshot.wagon->output.creepage.fill(kUnknown);
  snapshot.coupler_force_n[99] = kUnknown;
  const Picture picture = board.Draw(snapshot, {FindQuantity("slip"), 99});
  int dashes = 0;
  for (const Drawing* part : PartsOf(picture)) {
    for (const Text& text : part->texts()) {
      EXPECT_EQ(std::string::npos, text.words.find("nan")) << text.words;
      if (text.words.rfind("- ", 0) == 0) ++dashes;
    }
  }
  EXPECT_EQ(8, dashes);  // load and slip of four wheelsets
  for (const Vertex& vertex : picture.close_up.vertices()) {
    ASSERT_TRUE(std::isfinite(vertex.at.right) && std::isfinite(vertex.at.up));
  }
}

TEST(Board, SpeedIsThatOfTheMomentum) {
  const ScenarioParams scenario = Load("emergency", {"train.consist[0].vehicle.carbody.mass_kg=900000"});
  Snapshot snapshot = Travelled(scenario, 0.0, 0.0);
  const train_dynamics::Consist consist(scenario.train);
  snapshot.speed_mps[0] = 11.0;
  double mass_kg = 0.0;
  for (int i = 0; i < consist.vehicles(); ++i) mass_kg += consist.vehicle(i).TotalMass();
  const double expected = 22.0 - 11.0 * consist.vehicle(0).TotalMass() / mass_kg;
  EXPECT_LT(expected, 22.0 - 11.0 / consist.vehicles() - 0.1);  // not the mean over vehicles
  bool shown = false;
  const Picture picture = Board(scenario).Draw(snapshot, {});
  for (const Text& text : picture.numbers.texts()) {
    shown = shown || text.words == fmt::format("{:.1f} km/h", 3.6 * expected);
  }
  EXPECT_TRUE(shown);
}

TEST(Board, SlipOfAnEmergencyStopIsSeen) {
  const ScenarioParams scenario = Load("emergency");
  Snapshot snapshot = Travelled(scenario, 0.0, 0.0);
  snapshot.creepage.assign(242, 4e-4);
  const Quantity& slip = *FindQuantity("slip");
  Board board(scenario);
  const Color color = ColorOf(slip, 0.04, 0.05);
  EXPECT_GT(AreaOf(board.Draw(snapshot, {&slip, 0}).train, color), 0.0);
}

TEST(Board, FindsTheLocomotivesOfThePapersTrain) {
  EXPECT_EQ((std::vector<int>{0, 121}), Board(Load("emergency")).locomotives());
  EXPECT_TRUE(Board(Load("dip")).locomotives().empty());
}

}  // namespace
}  // namespace train_brake_rviz
