#include "train_run/train_run.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_results/resume.h"

namespace {

std::mutex g_mutex;
std::vector<std::string> g_synced;  // names of files, in the order in which the disk had them

int Sync(long number, int descriptor) {
  const auto file = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor));
  const std::scoped_lock lock(g_mutex);
  g_synced.push_back(file.filename());
  return static_cast<int>(syscall(number, descriptor));
}

}  // namespace

// In the place of the C library's, for all of this program.
extern "C" int fsync(int descriptor) { return Sync(SYS_fsync, descriptor); }
extern "C" int fdatasync(int descriptor) { return Sync(SYS_fdatasync, descriptor); }

namespace train_run {
namespace {

namespace fs = std::filesystem;
using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;

/// A coupled train of four vehicles, whose mean start position is not 0, for 2 s with a record each 10 ms.
LoadedScenario Scenario() {
  return train_dynamics::config::LoadScenario(
      std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml",
      {"model=ltd", "train={name: t, connection: calibrated, consist: [{vehicle: ore_wagon, count: 4}]}",
       "brake=single_vehicle", "detail_vehicles=[]", "duration_s=2"});
}

class TrainRunTest : public testing::Test {
 protected:
  TrainRunTest() { fs::remove_all(folder_); }
  ~TrainRunTest() override { fs::remove_all(folder_); }

  train_results::OutputOptions Options() const {
    train_results::OutputOptions options;
    options.folder = folder_.string();
    options.checkpoint_interval_s = 100.0;  // only at the end
    return options;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("train_run_test_" + std::to_string(getpid()));
};

TEST_F(TrainRunTest, InterruptedGoesOnToARecordAndResumedToTheSameBits) {
  const LoadedScenario scenario = Scenario();
  train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, 1);
  TrainRun whole(scenario.params, scenario.consist, vehicles, scenario.pressures);
  double start_m = 0.0, end_m = 0.0;
  whole.AddObserver([&](const TrainRecord& record) {
    if (record.exchange == 0) start_m = record.mean_position_m;
    end_m = record.mean_position_m;
  });
  whole.Go({});
  EXPECT_EQ(whole.exit_code(), kSuccess);
  ASSERT_LT(start_m, -1.0);  // else the test would not see a start position that is lost

  const auto per_record = static_cast<std::uint64_t>(scenario.params.ExchangesPerRecord());
  ASSERT_GT(per_record, 2u);
  {
    train_results::RunOutput output(Options(), scenario.files, scenario.params);
    train_dynamics::InProcessTransport again(scenario.params, scenario.consist, 1);
    TrainRun cut(scenario.params, scenario.consist, again, scenario.pressures, nullptr, &output);
    RunHooks hooks;
    hooks.ends = [&] { return cut.master().exchange() == 5 * per_record + 1; };
    cut.Go(hooks);
    cut.Finish(1.0);
    EXPECT_EQ(cut.exit_code(), kInterrupted);
    EXPECT_EQ(cut.master().exchange(), 6 * per_record);
  }

  const train_results::ResumedRun left = train_results::LoadResumedRun(folder_, {});
  EXPECT_EQ(left.checkpoint.exchange, 6 * per_record);
  train_results::RunOutput output(Options(), left);
  train_dynamics::InProcessTransport again(scenario.params, scenario.consist, 1);
  TrainRun resumed(left.scenario.params, left.scenario.consist, again, left.scenario.pressures, &left.checkpoint,
                   &output);
  double travelled_m = 0.0;
  resumed.AddObserver(
      [&](const TrainRecord& record) { travelled_m = record.mean_position_m - record.at_time_zero.mean_position_m; });
  resumed.Go({});
  resumed.Finish(1.0);
  EXPECT_EQ(resumed.exit_code(), kSuccess);
  EXPECT_EQ(resumed.master().state_digest(), whole.master().state_digest());
  EXPECT_EQ(travelled_m, end_m - start_m);
}

TEST_F(TrainRunTest, WhatACheckpointRefersToIsOnTheDiskBeforeIt) {
  const LoadedScenario scenario = Scenario();
  train_results::OutputOptions options = Options();
  options.checkpoint_interval_s = 0.5;
  options.csv = true;
  g_synced.clear();
  {
    train_results::RunOutput output(options, scenario.files, scenario.params);
    train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, 1);
    TrainRun run(scenario.params, scenario.consist, vehicles, scenario.pressures, nullptr, &output);
    run.Go({});
    run.Finish(1.0);
  }
  int checkpoints = 0;
  auto since = g_synced.begin();
  for (auto i = g_synced.begin(); i != g_synced.end(); ++i) {
    if (i->rfind("checkpoint", 0) != 0) continue;
    ++checkpoints;
    const auto has = [&](const std::string& begin) {
      return std::any_of(since, i, [&](const std::string& name) { return name.rfind(begin, 0) == 0; });
    };
    EXPECT_TRUE(has("train.bag")) << checkpoints;
    EXPECT_TRUE(has("train_history.csv")) << checkpoints;
    since = i;
  }
  EXPECT_GE(checkpoints, 4);
}

TEST_F(TrainRunTest, AFaultOfTheTransportPassesThroughAndResultsAreKept) {
  const LoadedScenario scenario = Scenario();
  train_results::RunOutput output(Options(), scenario.files, scenario.params);
  train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, 1);
  TrainRun run(scenario.params, scenario.consist, vehicles, scenario.pressures, nullptr, &output);
  struct LinkLost {};
  RunHooks hooks;
  hooks.exchanged = [&](double) {
    if (run.master().exchange() == 100) throw LinkLost();
  };
  EXPECT_THROW(run.Go(hooks), LinkLost);
  const std::string json = run.Finish(1.0, "the link was lost");
  EXPECT_NE(json.find("\"fault\": \"the link was lost\""), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "summary.json"));
  EXPECT_TRUE(fs::exists(folder_ / "train.bag"));
}

}  // namespace
}  // namespace train_run
