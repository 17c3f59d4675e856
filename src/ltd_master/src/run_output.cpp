#include "ltd_master/run_output.h"

#include <exception>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <vector>

#include "train_dynamics/config/writer.h"

namespace ltd_master {
namespace {

namespace fs = std::filesystem;

/// First line of the config.yaml of a run: the mark of a folder that holds results of ours and nothing of the user's.
constexpr const char* kMark =
    "# A run of train_brake: everything resolved. Running it again gives the same bits.";

fs::path FolderOf(const fs::path& file) { return fs::weakly_canonical(fs::absolute(file)).parent_path(); }

bool IsResult(const std::string& name) {
  static const std::regex pattern(
      "train\\.bag(\\.active)?|(report\\.html|summary\\.json|config\\.yaml)(\\.unfinished)?|"
      "(pressure_table|train_history|pressures|couplers|vehicles|wagon_[0-9]+)\\.csv");
  return std::regex_match(name, pattern);
}

bool HasMark(const fs::path& folder) {
  std::ifstream config(folder / "config.yaml");
  std::string line;
  return std::getline(config, line) && line == kMark;
}

/// Makes the folder; clears it of the results of an earlier run, but of nothing that a user may have put there.
void PrepareFolder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() + " is not a folder: results cannot go there");
  }
  fs::create_directories(folder);
  const bool ours = HasMark(folder);
  std::vector<fs::path> results;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (IsResult(entry.path().filename().string())) results.push_back(entry.path());
  }
  if (!ours && !results.empty()) {
    throw std::runtime_error(folder.string() + " holds " + results.front().filename().string() +
                             ", but no run of train_brake: choose another folder for the results");
  }
  for (const fs::path& file : results) fs::remove(file);
}

/// Everything that a repetition of the run needs, so that it gives the same bits.
void WriteResolvedConfig(train_dynamics::ScenarioParams scenario, const fs::path& folder) {
  if (!scenario.pressure_table.empty()) {
    fs::copy_file(scenario.pressure_table, folder / "pressure_table.csv",
                  fs::copy_options::overwrite_existing);
    scenario.pressure_table = "pressure_table.csv";
  }
  WriteFile(folder / "config.yaml", std::string(kMark) + "\n" + train_dynamics::config::Write(scenario));
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
  if (options.record_bag) bag_ = std::make_unique<BagRecorder>((folder_ / "train.bag").string(), scenario);
  if (options.csv) csv_ = std::make_unique<CsvRecorder>(folder_);
  if (bag_ == nullptr && csv_ == nullptr) return;
  thread_ = std::make_unique<RecorderThread>([this](const train_dynamics::TrainRecord& record) {
    if (bag_ != nullptr) bag_->Record(record);
    if (csv_ != nullptr) csv_->Record(record);
  });
}

void RunOutput::Record(const train_dynamics::TrainRecord& record) {
  if (thread_ != nullptr) thread_->Record(record);
}

void RunOutput::Finish(const train_dynamics::TrainMaster& master, const std::string& summary_json) {
  if (folder_.empty()) return;
  std::exception_ptr error;
  const auto attempt = [&error](const auto& step) {
    try {
      step();
    } catch (const std::exception&) {
      if (error == nullptr) error = std::current_exception();
    }
  };
  if (thread_ != nullptr) attempt([&] { thread_->Finish(); });
  if (bag_ != nullptr) attempt([&] { bag_->Close(); });
  if (csv_ != nullptr) attempt([&] { csv_->Close(master); });
  attempt([&] { WriteFile(folder_ / "summary.json", summary_json); });
  if (error != nullptr) std::rethrow_exception(error);
}

}  // namespace ltd_master
