// When a train has stopped, moved again and rolled back.

#include "train_dynamics/train/run_summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"

namespace train_dynamics {
namespace {

/// A single LTD wagon's run from 36 km/h.
struct WagonRun {
  explicit WagonRun(std::vector<std::string> settings)
      : scenario(Load(std::move(settings))),
        vehicles(scenario.params, scenario.consist, 1),
        master(scenario.params, scenario.consist, vehicles, scenario.pressures),
        summary(scenario.params) {
    master.AddObserver([this](const TrainRecord& record) { summary.Observe(record); });
    master.Start();
    while (!master.Done()) master.Exchange();
  }
  static config::LoadedScenario Load(std::vector<std::string> settings) {
    settings.insert(settings.begin(), {"model=ltd", "initial_speed_kmh=36"});
    return config::LoadScenario(TRAIN_BRAKE_CONFIG_DIR "/scenarios/single_wagon_stop.yaml", settings);
  }

  config::LoadedScenario scenario;
  InProcessTransport vehicles;
  TrainMaster master;
  RunSummary summary;
};

// Without brakes a wagon comes to a stand on a grade only for an instant, and then rolls away: whether it did must not
// depend on where the records lie.
TEST(RunSummary, ARunawayTrainHasStoppedOnceAndRolledBackWhateverTheRecords) {
  for (const std::string interval_s : {"0.01", "0.03", "0.3"}) {
    for (const std::string duration_s : {"60", "60.6", "61.2"}) {
      const WagonRun run({"track.grades=[{from_m: 0, grade_percent: 3}]", "commands=[]", "duration_s=" + duration_s,
                          "record_interval_s=" + interval_s, "ledger_interval_s=" + interval_s});
      SCOPED_TRACE(duration_s + " s, records every " + interval_s + " s");
      EXPECT_FALSE(run.summary.Stands());
      EXPECT_TRUE(run.summary.RolledBack());
      ASSERT_EQ(run.summary.stops().size(), 1u);
      const RunSummary::Stop& stop = run.summary.stops().front();
      // v0^2 / (2 a) and v0 / a with a between g 3 % and that with the resistance of 1 N/kN at most, m_e / m = 7.2 %.
      const double least = 9.81 * 0.030 / 1.0722, most = 9.81 * 0.0312 / 1.0722;
      EXPECT_GT(stop.time_s, 10.0 / most);
      EXPECT_LT(stop.time_s, 10.0 / least + 0.3);
      EXPECT_GT(stop.distance_m, 50.0 / most);
      EXPECT_LT(stop.distance_m, 50.0 / least);
      EXPECT_GE(stop.until_s, stop.time_s);
      EXPECT_GT(run.summary.BehindFurthest(), 50.0);
    }
  }
}

TEST(RunSummary, ATrainThatIsReleasedOnAGradeHasStoppedAndMovedAgain) {
  const WagonRun run({"track.grades=[{from_m: -1000, grade_percent: -1}]", "duration_s=160",
                      "commands=[{time_s: 1, kind: apply, reduction_kpa: 170}, {time_s: 90, kind: release}]"});
  EXPECT_FALSE(run.summary.Stands());
  EXPECT_FALSE(run.summary.RolledBack());
  ASSERT_FALSE(run.summary.stops().empty());
  EXPECT_LT(run.summary.stops().front().time_s, 90.0);
  EXPECT_GT(run.summary.stops().front().until_s, 90.0);
}

TEST(RunSummary, ATrainThatStandsAtTheEndHasStopped) {
  for (const char* direction : {"36", "-36"}) {
    const WagonRun run({std::string("initial_speed_kmh=") + direction, "duration_s=90"});
    EXPECT_TRUE(run.summary.Stands());
    EXPECT_FALSE(run.summary.RolledBack());
    ASSERT_FALSE(run.summary.stops().empty());
    EXPECT_TRUE(std::isnan(run.summary.stops().back().until_s));
  }
}

}  // namespace
}  // namespace train_dynamics
