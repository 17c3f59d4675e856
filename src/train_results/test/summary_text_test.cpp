#include "train_results/summary_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace train_results {
namespace {

using nlohmann::json;

/// Of a train of three vehicles that still moves when its time is over.
json Moving() {
  return {{"scenario", "mine"},
          {"model", "ltd"},
          {"vehicles", 3},
          {"simulated_s", 60.0},
          {"complete", true},
          {"ended_by", "duration_s"},
          {"fault", nullptr},
          {"distance_m", 1234.56},
          {"final_speed_kmh", {{"mean", 7.25}}},
          {"stopped", false},
          {"stop_time_s", nullptr},
          {"stop_distance_m", nullptr},
          {"rolled_back", false},
          {"left_route_s", nullptr},
          {"max_tension_n", {{"value", 123456.0}, {"connection", 1}, {"time_s", 3.25}}},
          {"max_compression_n", {{"value", -65432.0}, {"connection", 2}, {"time_s", 4.5}}},
          {"partings", json::array()},
          {"twin", nullptr},
          {"slides", {{"slides", 0}, {"flat_risks", 0}, {"wheelsets", json::array()}}}};
}

std::string Text(const json& summary) { return SummaryText(summary.dump()); }

TEST(SummaryText, MovingTrain) {
  const std::string text = Text(Moving());
  EXPECT_PRED_FORMAT2(testing::IsSubstring,
                      "mine: 3 vehicles, ltd model, ends after 60.0 s and 1234.6 m at 7.2 km/h\n  (duration_s is over;",
                      text);
  EXPECT_PRED_FORMAT2(testing::IsSubstring,
                      "largest tension 123 kN in connection 1 at 3.2 s, "
                      "largest compression 65 kN in connection 2 at 4.5 s\n",
                      text);
  for (const char* absent : {"slid", "parted", "rolled back", "route", "INCOMPLETE", "faster"})
    EXPECT_PRED_FORMAT2(testing::IsNotSubstring, absent, text);
}

TEST(SummaryText, StandingTrain) {
  json summary = Moving();
  summary.update({{"stopped", true}, {"ended_by", "until"}, {"stop_time_s", 58.5}, {"stop_distance_m", 987.6}});
  const std::string text = Text(summary);
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "stands after 58.5 s and 987.6 m\n", text);
  EXPECT_PRED_FORMAT2(testing::IsNotSubstring, "duration_s", text);
}

TEST(SummaryText, TellsWhatShouldNotHappen) {
  json summary = Moving();
  summary["vehicles"] = 1;
  summary["complete"] = false;
  summary["ended_by"] = nullptr;
  summary["fault"] = "vehicle 1: burst";
  summary["rolled_back"] = true;
  summary["rolled_back_m"] = 2.5;
  summary["left_route_s"] = 12.0;
  summary["partings"] = {{{"connection", 7}, {"time_s", 8.0}}, {{"connection", 9}, {"time_s", 9.0}}};
  summary["slides"] = {{"slides", 5}, {"flat_risks", 1}, {"wheelsets", {json::object(), json::object()}}};
  const std::string text = Text(summary);
  for (const char* line :
       {"mine: 1 vehicle, ", "  the train parted: connection 7 at 8.0 s, connection 9 at 9.0 s\n",
        "  it rolled back, at the end by 2.5 m\n", "  it left its route at 12.0 s\n",
        "  2 wheelsets slid, 5 slides in all, with a risk of a flat on 1\n", "  INCOMPLETE: vehicle 1: burst\n"}) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, line, text);
  }
  EXPECT_PRED_FORMAT2(testing::IsNotSubstring, "duration_s", text);
  summary["fault"] = nullptr;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "INCOMPLETE: the run was stopped\n", Text(summary));
}

TEST(SummaryText, TellsHowFarATwinWent) {
  json summary = Moving();
  summary["twin"] = {{"start_offset_kmh", 1e-9},
                     {"max_tension_spread_n", 3.0},
                     {"max_compression_spread_n", 40.0},
                     {"distance_spread_m", 0.5}};
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "a start 1e-09 km/h faster changes the largest forces by up to 40 N",
                      Text(summary));
}

TEST(SummaryText, LeavesOutWhatIsNotThere) {
  json summary = Moving();  // one vehicle has no connection; numbers that are not finite are null
  for (const char* key : {"distance_m", "partings", "slides", "twin", "rolled_back", "left_route_s"})
    summary.erase(key);
  summary["max_tension_n"] = nullptr;
  summary["max_compression_n"]["value"] = nullptr;
  summary["final_speed_kmh"]["mean"] = nullptr;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "ends after 60.0 s\n", Text(summary));
  EXPECT_PRED_FORMAT2(testing::IsNotSubstring, "largest", Text(summary));
}

TEST(SummaryText, RefusesWhatIsNoSummary) {
  for (const char* text : {"", "{", "[]", "3", "{}", R"({"scenario": 3})"})
    EXPECT_THROW(SummaryText(text), NoSummary) << text;
  json summary = Moving();
  summary["partings"] = "none";
  EXPECT_THROW(Text(summary), NoSummary);
}

}  // namespace
}  // namespace train_results
