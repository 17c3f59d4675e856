// What recording costs: one iteration is one record of the paper's 2D train, four of its vehicles in detail; as many
// iterations as the emergency stop has records.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_results/bag_recorder.h"
#include "train_results/csv_recorder.h"

namespace train_results {
namespace {

namespace fs = std::filesystem;

constexpr int kRecords = 7001;

/// A braking train, its last record.
struct Braking {
  train_dynamics::config::LoadedScenario scenario = train_dynamics::config::LoadScenario(
      std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml", {"duration_s=8"});
  train_dynamics::TrainRecord last;

  Braking() {
    train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, 1);
    train_dynamics::TrainMaster master(scenario.params, scenario.consist, vehicles, scenario.pressures);
    master.AddObserver([&](const train_dynamics::TrainRecord& record) { last = record; });
    master.Start();
    while (!master.Done()) master.Exchange();
  }
};

const Braking& TheTrain() {
  static const Braking train;
  return train;
}

/// That record as if of another exchange.
train_dynamics::TrainRecord RecordOf(std::uint64_t number) {
  train_dynamics::TrainRecord record = TheTrain().last;
  record.exchange = number;
  record.ledger.reset();  // one record in a hundred has one
  return record;
}

/// A folder that is gone afterwards.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "recording_bench_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    path_ = pattern;
  }
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What the run itself does: the rest is done by another thread.
void CopyRecord(benchmark::State& state) {
  train_dynamics::TrainRecord copy = TheTrain().last;
  std::uint64_t number = 0;
  for (auto _ : state) {
    copy = RecordOf(number++);
    benchmark::DoNotOptimize(copy);
  }
}

void WriteBag(benchmark::State& state) {
  const Folder folder;
  BagRecorder bag((folder.path() / "train.bag").string(), TheTrain().scenario.params);
  std::uint64_t number = 0;
  for (auto _ : state) bag.Record(RecordOf(number++));
  bag.Close();
}

void WriteTables(benchmark::State& state) {
  const Folder folder;
  CsvRecorder tables(folder.path());
  std::uint64_t number = 0;
  for (auto _ : state) tables.Record(RecordOf(number++));
}

BENCHMARK(CopyRecord)->Name("copy")->Iterations(kRecords)->MeasureProcessCPUTime();
BENCHMARK(WriteBag)->Name("bag")->Iterations(kRecords)->MeasureProcessCPUTime();
BENCHMARK(WriteTables)->Name("tables")->Iterations(kRecords)->MeasureProcessCPUTime();

}  // namespace
}  // namespace train_results

BENCHMARK_MAIN();
