#include "train_dynamics/train/energy_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate.h"

namespace train_dynamics {
namespace {

TEST(Ledger, ClosesForEveryScenarioInTwoDimensions) {
  int scenarios = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios")) {
    if (file.path().extension() != ".yaml") continue;
    const std::string name = file.path().stem();
    ++scenarios;
    // table_one_test holds the ledgers of these, to their ends.
    if (std::count(kPaperScenarios.begin(), kPaperScenarios.end(), name) > 0) continue;
    const config::LoadedScenario shipped = config::LoadScenario(ScenarioFile(name), {});
    if (shipped.params.MeanInitialSpeed() == 0.0) continue;  // the scale below is the kinetic energy at the start
    const std::vector<ConsistGroupParams>& consist = shipped.params.train.consist;
    const bool has_bodies = std::all_of(consist.begin(), consist.end(),
                                        [](const ConsistGroupParams& group) { return !group.vehicle.IsOneMass(); });
    std::vector<std::string> overrides;
    if (has_bodies) overrides.push_back("model=2d");  // else as it ships, where some vehicles are one mass
    constexpr int kFew = 10;
    if (shipped.consist.vehicles() > kFew && shipped.params.duration_s > 10.0)
      overrides.push_back("duration_s=10");  // long trains are slow
    ExpectLedgerCloses(Simulate(name, overrides), name);
  }
  EXPECT_GE(scenarios, 6);
}

}  // namespace
}  // namespace train_dynamics
