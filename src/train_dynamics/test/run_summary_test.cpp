// When a train has stopped, moved again and rolled back.

#include "train_dynamics/train/run_summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"

namespace train_dynamics {
namespace {

/// The summary of a single LTD wagon's run from 36 km/h, as JSON text.
std::string SummaryOf(std::vector<std::string> settings) {
  settings.insert(settings.begin(), {"model=ltd", "initial_speed_kmh=36"});
  const config::LoadedScenario scenario =
      config::LoadScenario(TRAIN_BRAKE_CONFIG_DIR "/scenarios/single_wagon_stop.yaml", settings);
  InProcessTransport vehicles(scenario.params, scenario.consist, 1);
  TrainMaster master(scenario.params, scenario.consist, vehicles, scenario.pressures);
  RunSummary summary(scenario.params);
  master.AddObserver([&](const TrainRecord& record) { summary.Observe(record); });
  master.Start();
  while (!master.Done()) master.Exchange();
  return summary.Json(master, 1.0, "");
}

bool Has(const std::string& json, const std::string& text) { return json.find(text) != std::string::npos; }

/// The number behind the first `"key": ` after `from`.
double NumberAt(const std::string& json, const std::string& key, std::size_t from = 0) {
  const std::size_t at = json.find("\"" + key + "\": ", from);
  EXPECT_NE(at, std::string::npos) << key;
  return std::stod(json.substr(at + key.size() + 4));
}

const std::vector<std::string> kUphill = {"track.grades=[{from_m: 0, grade_percent: 3}]", "commands=[]"};

std::string Uphill(const std::string& duration_s, const std::string& record_interval_s) {
  std::vector<std::string> settings = kUphill;
  settings.push_back("duration_s=" + duration_s);
  settings.push_back("record_interval_s=" + record_interval_s);
  settings.push_back("ledger_interval_s=" + record_interval_s);
  return SummaryOf(settings);
}

// Without brakes a wagon comes to a stand on a grade only for an instant, and then rolls away: whether it did must not
// depend on where the records lie.
TEST(RunSummary, ARunawayTrainHasStoppedOnceAndRolledBackWhateverTheRecords) {
  for (const char* interval_s : {"0.01", "0.03", "0.3"}) {
    for (const char* duration_s : {"60", "60.6", "61.2"}) {
      const std::string json = Uphill(duration_s, interval_s);
      SCOPED_TRACE(std::string(duration_s) + " s, records every " + interval_s + " s");
      EXPECT_TRUE(Has(json, "\"stopped\": false"));
      EXPECT_TRUE(Has(json, "\"stop_time_s\": null"));
      EXPECT_TRUE(Has(json, "\"rolled_back\": true"));
      const std::size_t stops = json.find("\"stops\": [{");
      ASSERT_NE(stops, std::string::npos);
      EXPECT_EQ(json.find("}, {", stops), std::string::npos) << "one stop";
      // v0^2 / (2 a) and v0 / a with a between g 3 % and that with the resistance of 1 N/kN at most, m_e / m = 7.2 %.
      const double least = 9.81 * 0.030 / 1.0722, most = 9.81 * 0.0312 / 1.0722;
      EXPECT_GT(NumberAt(json, "time_s", stops), 10.0 / most);
      EXPECT_LT(NumberAt(json, "time_s", stops), 10.0 / least + 0.3);
      EXPECT_GT(NumberAt(json, "distance_m", stops), 50.0 / most);
      EXPECT_LT(NumberAt(json, "distance_m", stops), 50.0 / least);
      EXPECT_GT(NumberAt(json, "until_s", stops), NumberAt(json, "time_s", stops) - 1e-9);
      EXPECT_GT(NumberAt(json, "rolled_back_m"), 50.0);
    }
  }
}

TEST(RunSummary, ATrainThatIsReleasedOnAGradeHasStoppedAndMovedAgain) {
  const std::string json =
      SummaryOf({"track.grades=[{from_m: -1000, grade_percent: -1}]", "duration_s=160",
                 "commands=[{time_s: 1, kind: apply, reduction_kpa: 170}, {time_s: 90, kind: release}]"});
  EXPECT_TRUE(Has(json, "\"stopped\": false"));
  EXPECT_TRUE(Has(json, "\"rolled_back\": false"));
  const std::size_t stops = json.find("\"stops\": [{");
  ASSERT_NE(stops, std::string::npos);
  EXPECT_LT(NumberAt(json, "time_s", stops), 90.0);
  EXPECT_GT(NumberAt(json, "until_s", stops), 90.0);
}

TEST(RunSummary, ATrainThatStandsAtTheEndHasStopped) {
  for (const char* direction : {"36", "-36"}) {
    const std::string json = SummaryOf({std::string("initial_speed_kmh=") + direction, "duration_s=90"});
    EXPECT_TRUE(Has(json, "\"stopped\": true"));
    EXPECT_TRUE(Has(json, "\"rolled_back\": false"));
    EXPECT_TRUE(Has(json, "\"until_s\": null"));
    EXPECT_EQ(NumberAt(json, "stop_time_s"), NumberAt(json, "time_s", json.find("\"stops\"")));
  }
}

}  // namespace
}  // namespace train_dynamics
