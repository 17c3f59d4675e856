// No emergency part may fire in service, quick service, release or recharge, of any shipped train, at any cell count.
// A longer search: train_sim air-test SCENARIO --trials N --seed S.

#include "train_dynamics/brake/pneumatic/emergency_search.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "simulate.h"

namespace train_dynamics {
namespace {

std::string Told(const std::vector<UndesiredEmergency>& found) {
  std::string text;
  for (const UndesiredEmergency& e : found) {
    text += "trial " + std::to_string(e.trial) + ": vehicle " + std::to_string(e.vehicle) + " at " +
            std::to_string(e.time_s) + " s after";
    for (const BrakeCommand& c : e.commands)
      text += " " + std::to_string(c.time_s) + ":" +
              (c.kind == BrakeCommandKind::kApply ? std::to_string(c.reduction_kpa) : "release");
    text += "\n";
  }
  return text;
}

std::vector<double> Lengths(const Consist& consist) {
  std::vector<double> length_m;
  for (int i = 0; i < consist.vehicles(); ++i) length_m.push_back(consist.vehicle(i).length_m);
  return length_m;
}

// Every shipped train with a pneumatic brake, and the paper's train with each of the shipped brakes.
TEST(EmergencySearch, FindsNoneInAnyShippedTrain) {
  std::vector<config::LoadedScenario> trains;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    config::LoadedScenario loaded = config::LoadScenario(entry.path().string(), {});
    if (loaded.params.brake && loaded.params.brake->kind == BrakeSystemKind::kPneumatic)
      trains.push_back(std::move(loaded));
  }
  EXPECT_GE(trains.size(), 8u);
  for (const char* brake : {"ab_head_end", "ab_distributed", "ecp", "uic_p", "uic_g_p"})
    trains.push_back(config::LoadScenario(ScenarioFile("emergency_ab"), {std::string("brake=") + brake}));
  std::uint32_t seed = 1;
  for (const config::LoadedScenario& train : trains) {
    for (int cells : {1, 2, 4}) {
      EmergencySearch search;
      search.trials = cells == 4 ? 1 : 3;
      search.seed = seed++;
      search.cells_per_vehicle = cells;
      search.mean_pause_s = cells == 4 ? 5.0 : 10.0;
      search.commands = 5;
      EXPECT_EQ(Told(FindUndesiredEmergencies(train.params.brake->pneumatic, Lengths(train.consist), search)), "")
          << train.params.name << ", " << train.params.brake->name << ", cells " << cells << ", seed " << search.seed;
    }
  }
}

// What it looks for exists: large volumes and wide passages of quick service make a long train trip itself.
TEST(EmergencySearch, FindsThoseOfWidePassages) {
  PneumaticBrakeParams params;
  params.valves[0].direct.quick_service_volume_l = 3.0;
  params.valves[0].direct.quick_service_kpa = 200.0;  // 600 J from the 12 l of a vehicle's pipe: a fall by 50 kPa
  params.valves[0].direct.quick_service_opening_mm = 6.0;
  EmergencySearch search;
  search.trials = 5;
  const auto found = FindUndesiredEmergencies(params, std::vector<double>(150, 13.0), search);
  ASSERT_FALSE(found.empty());
  EXPECT_FALSE(found[0].commands.empty());
  EXPECT_GT(found[0].vehicle, 0);
}

}  // namespace
}  // namespace train_dynamics
