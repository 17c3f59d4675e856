// What recorders leave in a checkpoint, forged: the input as it is, and as changes (two bytes of place, one of value)
// of what they did leave. What is refused must have touched nothing; what is not must go on without harm.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "fuzz.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_results/bag_recorder.h"
#include "train_results/csv_recorder.h"

namespace train_results {
namespace {

namespace fs = std::filesystem;
using train_dynamics::Bytes;

std::map<fs::path, std::string> FilesBelow(const fs::path& folder) {
  std::map<fs::path, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    files[entry.path()] = {std::istreambuf_iterator<char>(stream), {}};
  }
  return files;
}

/// A run of two wagons, both in detail, in a folder; beside it a file that does not belong to the run.
struct Recorded {
  train_brake_build::fuzz::Scratch scratch;
  fs::path outside = fs::path(scratch.Put("outside", "untouched")).parent_path();
  fs::path folder = outside / "run";
  int vehicles = 2;
  train_dynamics::TrainRecord last;
  Bytes bag, csv;
  std::map<fs::path, std::string> files;  ///< of the run and outside

  Recorded() {
    fs::create_directory(folder);
    const train_dynamics::config::LoadedScenario scenario = train_dynamics::config::LoadScenario(
        std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml",
        {"train={name: t, connection: calibrated, consist: [{vehicle: ore_wagon, count: 2}]}", "brake=single_vehicle",
         "detail_vehicles=[1, 2]", "duration_s=0.02"});
    BagRecorder bag_recorder(BagFile(), scenario.params);
    CsvRecorder csv_recorder(folder);
    train_dynamics::InProcessTransport transport(scenario.params, scenario.consist, 1);
    train_dynamics::TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
    master.AddObserver([&](const train_dynamics::TrainRecord& record) {
      bag_recorder.Record(record);
      csv_recorder.Record(record);
      last = record;
      if (record.exchange != 10) return;  // more comes behind the checkpoint
      bag = bag_recorder.Checkpoint();
      csv = csv_recorder.Checkpoint();
    });
    master.Start();
    while (!master.Done()) master.Exchange();
    bag_recorder.Close();
    csv_recorder.Close();
    files = FilesBelow(outside);
  }

  std::string BagFile() const { return folder / "train.bag"; }

  void Restore() const {
    fs::remove_all(folder);
    for (const auto& [file, content] : files) {
      fs::create_directories(file.parent_path());
      std::ofstream(file, std::ios::binary) << content;
    }
  }
};

template <class Recorder, class... Where>
void Try(const Recorded& run, const Bytes& checkpoint, const Where&... where) {
  try {
    Recorder recorder(where..., checkpoint, run.vehicles);
    train_brake_build::fuzz::Require(FilesBelow(run.outside) == run.files, "looking changes nothing");
    recorder.GoOn();
    recorder.Record(run.last);
    recorder.Checkpoint();
  } catch (const train_dynamics::SnapshotError&) {
    train_brake_build::fuzz::Require(FilesBelow(run.outside) == run.files, "what is refused is left alone");
    return;
  } catch (const std::invalid_argument&) {
    train_brake_build::fuzz::Require(FilesBelow(run.outside) == run.files, "what is refused is left alone");
    return;
  }
  for (const auto& [file, content] : FilesBelow(run.outside)) {
    if (file.parent_path() == run.folder) continue;
    train_brake_build::fuzz::Require(run.files.count(file) != 0 && run.files.at(file) == content,
                                     "no other folder is touched");
  }
  run.Restore();
}

Bytes Changed(Bytes bytes, const std::uint8_t* changes, std::size_t size) {
  for (std::size_t i = 0; i + 3 <= size; i += 3) {
    bytes[(changes[i] + 256u * changes[i + 1]) % bytes.size()] = changes[i + 2];
  }
  return bytes;
}

}  // namespace
}  // namespace train_results

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace train_results;
  static const Recorded run;
  for (const Bytes& checkpoint : {Bytes(data, data + size), Changed(run.bag, data, size)}) {
    Try<BagRecorder>(run, checkpoint, run.BagFile());
  }
  for (const Bytes& checkpoint : {Bytes(data, data + size), Changed(run.csv, data, size)}) {
    Try<CsvRecorder>(run, checkpoint, run.folder);
  }
  return 0;
}
