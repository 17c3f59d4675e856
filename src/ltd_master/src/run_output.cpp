#include "ltd_master/run_output.h"

#include <fstream>
#include <stdexcept>

#include "train_dynamics/config/writer.h"

namespace ltd_master {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const fs::path& file) { return fs::weakly_canonical(fs::absolute(file)).parent_path(); }

/// Makes the folder and clears it of the results of an earlier run.
void PrepareFolder(const fs::path& folder) {
  fs::create_directories(folder);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool result = name == "train.bag" || name == "train.bag.active" || name == "summary.json" ||
                        name == "config.yaml" || name == "pressure_table.csv" ||
                        name == "train_history.csv" || name == "pressures.csv" || name == "couplers.csv" ||
                        name == "vehicles.csv" ||
                        (name.rfind("wagon_", 0) == 0 && entry.path().extension() == ".csv");
    if (result) fs::remove(entry.path());
  }
}

/// Everything that a repetition of the run needs, so that it gives the same bits.
void WriteResolvedConfig(train_dynamics::ScenarioParams scenario, const fs::path& folder) {
  if (!scenario.pressure_table.empty()) {
    fs::copy_file(scenario.pressure_table, folder / "pressure_table.csv",
                  fs::copy_options::overwrite_existing);
    scenario.pressure_table = "pressure_table.csv";
  }
  WriteFile(folder / "config.yaml", train_dynamics::config::Write(scenario));
}

}  // namespace

void WriteFile(const fs::path& file, const std::string& text) {
  const fs::path unfinished = file.string() + ".unfinished";
  std::ofstream stream(unfinished);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
  fs::rename(unfinished, file);
}

RunOutput::RunOutput(const OutputOptions& options, const std::string& scenario_file,
                     const train_dynamics::ScenarioParams& scenario)
    : folder_(options.folder) {
  if (folder_.empty()) return;
  for (const std::string& input : {scenario_file, scenario.pressure_table}) {
    if (!input.empty() && FolderOf(input) == fs::weakly_canonical(fs::absolute(folder_))) {
      throw std::runtime_error(options.folder + " is the folder of " + input +
                               ": choose another for the results");
    }
  }
  PrepareFolder(folder_);
  WriteResolvedConfig(scenario, folder_);
  if (options.record_bag) bag_ = std::make_unique<BagRecorder>((folder_ / "train.bag").string());
  if (options.csv) csv_ = std::make_unique<CsvRecorder>(folder_);
}

void RunOutput::Record(const train_dynamics::TrainRecord& record) {
  if (bag_ != nullptr) bag_->Record(record);
  if (csv_ != nullptr) csv_->Record(record);
}

void RunOutput::Finish(const train_dynamics::TrainMaster& master, const std::string& summary_json) {
  if (folder_.empty()) return;
  if (bag_ != nullptr) bag_->Close();
  if (csv_ != nullptr) csv_->Close(master);
  WriteFile(folder_ / "summary.json", summary_json);
}

}  // namespace ltd_master
