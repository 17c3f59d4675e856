#include "train_results/summary_json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"

namespace train_results {
namespace {

using nlohmann::json;
using train_dynamics::RunSummary;
using train_dynamics::TrainMaster;

/// Three LTD vehicles that brake for a while.
struct ShortRun {
  explicit ShortRun(const std::vector<std::string>& more = {})
      : scenario(Load(more)),
        vehicles(scenario.params, scenario.consist, 1),
        master(scenario.params, scenario.consist, vehicles, scenario.pressures),
        summary(scenario.params) {
    master.AddObserver([this](const train_dynamics::TrainRecord& record) { summary.Observe(record); });
    master.Start();
    while (!master.Done()) master.Exchange();
  }
  static train_dynamics::config::LoadedScenario Load(const std::vector<std::string>& more) {
    std::vector<std::string> settings{
        "model=ltd", "duration_s=3", "detail_vehicles=[]",
        "train={name: t, connection: calibrated, consist: [{vehicle: ore_wagon, count: 3}]}", "brake=single_vehicle"};
    settings.insert(settings.end(), more.begin(), more.end());
    return train_dynamics::config::LoadScenario(TRAIN_BRAKE_CONFIG_DIR "/scenarios/emergency.yaml", settings);
  }

  train_dynamics::config::LoadedScenario scenario;
  train_dynamics::InProcessTransport vehicles;
  TrainMaster master;
  RunSummary summary;
};

TEST(SummaryJson, NumbersReadBackToTheSameBits) {
  const ShortRun run;
  const double wall_s = 1.0 / 3.0;
  const json read = json::parse(SummaryJson(run.summary, run.master, wall_s, ""));
  EXPECT_EQ(read["wall_s"].get<double>(), wall_s);
  EXPECT_EQ(read["simulated_s"].get<double>(), run.master.time_s());
  EXPECT_EQ(read["energy"]["initial_j"].get<double>(), run.master.at_time_zero().stored_energy_j);
  EXPECT_EQ(read["energy"]["final_j"].get<double>(), run.summary.ledger().Stored());
  EXPECT_EQ(read["energy"]["residual_share"].get<double>(), run.summary.ResidualShare(run.master));
  for (const auto& [element, energy_j] : run.summary.ledger().dissipated_j)
    EXPECT_EQ(read["energy"]["dissipated_j"][element].get<double>(), energy_j) << element;
  double tension_n = 0.0;
  for (const auto& of : run.master.in_train_forces().Extremes()) tension_n = std::max(tension_n, of.tension_n);
  EXPECT_EQ(read["max_tension_n"]["value"].get<double>(), tension_n);
  EXPECT_EQ(std::stoull(read["state_digest"].get<std::string>(), nullptr, 16), run.summary.state_digest());
}

TEST(SummaryJson, WhatDoesNotExistIsNull) {
  const ShortRun run;
  const json read = json::parse(SummaryJson(run.summary, run.master, 1.0, ""));
  for (const char* const key : {"fault", "resumed_at_s", "stop_time_s", "stop_distance_m", "left_route_s", "twin"})
    EXPECT_TRUE(read.at(key).is_null()) << key;
  EXPECT_FALSE(read["stopped"].get<bool>());
  EXPECT_TRUE(read["complete"].get<bool>());
  EXPECT_EQ(read["ended_by"], "duration_s");
  // A train of one vehicle has no connections.
  const ShortRun alone({"train.consist[0].count=1"});
  const json of_one = json::parse(SummaryJson(alone.summary, alone.master, 1.0, ""));
  EXPECT_TRUE(of_one["max_tension_n"].is_null());
  EXPECT_TRUE(of_one["max_compression_n"].is_null());
}

TEST(SummaryJson, TextsSurviveWhateverTheyHold) {
  const ShortRun run({R"(name="a \"quoted\" \\ name, \u00e9")"});
  const json read = json::parse(SummaryJson(run.summary, run.master, 1.0, "line\nbreak \"and\" \xff"));
  EXPECT_EQ(read["scenario"], "a \"quoted\" \\ name, \u00e9");
  EXPECT_EQ(read["fault"], "line\nbreak \"and\" \xef\xbf\xbd");  // what is no UTF-8 is replaced
}

}  // namespace
}  // namespace train_results
