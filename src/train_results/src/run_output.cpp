#include "train_results/run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "strict_config/writer.h"
#include "train_results/conversions.h"
#include "train_results/plain_file.h"
#include "train_results/slide_tables.h"

namespace train_results {
namespace {

namespace fs = std::filesystem;
using train_dynamics::ScenarioParams;

constexpr const char* kBag = "train.bag";

/// First line of the config.yaml of a run: the mark of a folder that holds results of ours and nothing of the user's.
constexpr const char* kMark = "# A run of train_brake: everything resolved. Running it again gives the same bits.";

fs::path FolderOf(const fs::path& file) { return fs::weakly_canonical(fs::absolute(file)).parent_path(); }

bool IsResult(const std::string& name) {
  static const std::regex pattern(
      "train\\.bag(\\.active)?|(report\\.html|summary\\.json|config\\.yaml|replay\\.yaml|checkpoint|branched_"
      "from)(\\."
      "unfinished)?|"
      "(pressure_table|train_history|pressures|couplers|vehicles|slides|track_wear|wagon_[0-9]+)\\.csv");
  return std::regex_match(name, pattern);
}

bool HasMark(const fs::path& folder) {
  if (!fs::is_regular_file(folder / "config.yaml")) return false;
  std::string begin(std::strlen(kMark), ' ');
  std::ifstream(folder / "config.yaml").read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kMark;
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw std::runtime_error(folder.string() + " is not a folder: results cannot go there");
  }
  fs::create_directories(folder, error);
  if (!error) return;
  std::string reason = error.message();
  for (fs::path part = folder; part.has_relative_path(); part = part.parent_path()) {
    if (fs::is_symlink(fs::symlink_status(part, error)) && fs::status(part, error).type() == fs::file_type::not_found) {
      reason =
          part.string() + " is a symbolic link to " + fs::read_symlink(part, error).string() + ", which does not exist";
    }
  }
  throw std::runtime_error("the folder " + folder.string() + " cannot be made for the results: " + reason);
}

/// Removes the results of an earlier run from it, but no files of the user.
void ClearFolder(const fs::path& folder) {
  const bool ours = HasMark(folder);
  std::vector<fs::path> results;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (IsResult(entry.path().filename().string())) results.push_back(entry.path());
  }
  if (!ours && !results.empty()) {
    throw std::runtime_error(folder.string() + " holds " + results.front().filename().string() +
                             ", but no run of train_brake: choose another folder for the results");
  }
  for (const fs::path& file : results) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw std::runtime_error("cannot replace " + file.string() + ": " + error.message());
  }
}

/// Everything that a repetition of the run needs, so that it gives the same bits.
void WriteResolvedConfig(ScenarioParams scenario, const fs::path& folder) {
  if (!scenario.pressure_table.empty()) {
    const fs::path copy = folder / "pressure_table.csv";
    std::error_code error;
    fs::copy_file(scenario.pressure_table, copy, fs::copy_options::overwrite_existing, error);
    if (error) throw std::runtime_error("cannot write " + copy.string() + ": " + WriteFailure(error.value()));
    scenario.pressure_table = "pressure_table.csv";
  }
  WriteFile(folder / "config.yaml", std::string(kMark) + "\n" + ScenarioMessage(scenario).data);
}

/// The scenario of a run that was given live commands: with them, each at its exchange.
void WriteReplay(ScenarioParams scenario, const train_dynamics::CommandSchedule& schedule, const fs::path& folder) {
  bool is_live = false;
  for (const train_dynamics::GivenCommand& given : schedule.Given()) {
    if (!given.is_live) continue;
    is_live = true;
    scenario.commands.push_back(given.command);
    scenario.commands.back().exchange = static_cast<double>(given.exchange);
  }
  if (!is_live) return;
  if (!scenario.pressure_table.empty()) scenario.pressure_table = "pressure_table.csv";
  WriteFile(folder / "replay.yaml", "# A run with live commands, as a scenario: running it gives the same bits.\n" +
                                        strict_config::Write(scenario));
}

/// The recorders' data for continuing a run.
bool IsRecord(const std::string& name) {
  static const std::regex pattern("train\\.bag(\\.active)?|branched_from|(train_history|pressures|wagon_[0-9]+)\\.csv");
  return std::regex_match(name, pattern);
}

/// Bags as FILE.active: a copy is not a complete bag, in particular if the disk becomes full.
void CopyRecords(const fs::path& from, const fs::path& to) {
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    if (!IsRecord(name) || !fs::is_regular_file(entry.path())) continue;
    const fs::path copy = to / (name == kBag ? name + ".active" : name);
    try {
      fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
    } catch (const fs::filesystem_error& e) {
      fs::remove(copy);
      throw std::runtime_error("cannot copy " + entry.path().string() + " to " + to.string() + ": " +
                               e.code().message());
    }
  }
}

std::string TextOf(const train_dynamics::Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

long CheckpointExchanges(const OutputOptions& options, const ScenarioParams& scenario) {
  if (options.checkpoint_interval_s <= 0.0) return 0;
  const double records = std::round(options.checkpoint_interval_s / scenario.record_interval_s);
  return std::max(1L, std::lround(records)) * scenario.ExchangesPerRecord();
}

}  // namespace

RunOutput::RunOutput(const OutputOptions& options, const std::vector<fs::path>& inputs, const ScenarioParams& scenario)
    : options_(options),
      folder_(options.folder),
      scenario_(scenario),
      identity_(IdentityOf(scenario)),
      checkpoint_exchanges_(CheckpointExchanges(options, scenario)) {
  if (folder_.empty()) return;
  MakeFolder(folder_);
  for (const fs::path& input : inputs) {
    if (FolderOf(input) != fs::weakly_canonical(fs::absolute(folder_))) continue;
    throw std::runtime_error(options.folder + " is the folder of " + input.string() +
                             ", of which the scenario is made: choose another for the results");
  }
  lock_.emplace(folder_);
  if (HasMark(folder_) && fs::exists(folder_ / kCheckpointFile) && !fs::exists(folder_ / "summary.json")) {
    options.complain(folder_.string() + " held a run that was broken off; it is replaced (--resume goes on)");
  } else if (HasMark(folder_) && fs::exists(folder_ / "summary.json")) {
    options.complain(folder_.string() + " held the results of a run, which are replaced");
  }
  ClearFolder(folder_);
  WriteResolvedConfig(scenario, folder_);
  if (options.record_bag) bag_ = std::make_unique<BagRecorder>((folder_ / kBag).string(), scenario);
  if (options.csv) csv_ = std::make_unique<CsvRecorder>(folder_);
  StartThread();
}

RunOutput::RunOutput(const OutputOptions& options, const ResumedRun& run)
    : options_(options),
      folder_(options.folder.empty() ? run.folder : fs::path(options.folder)),
      scenario_(run.scenario.params),
      identity_(IdentityOf(run.scenario.params)),
      checkpoint_exchanges_(CheckpointExchanges(options, run.scenario.params)) {
  const bool is_elsewhere = fs::weakly_canonical(folder_) != fs::weakly_canonical(run.folder);
  if (run.is_branch && !is_elsewhere) {
    throw std::invalid_argument(
        "a run that is resumed with other values is a run of its own: give it a folder "
        "of its own, other than " +
        run.folder.string());
  }
  MakeFolder(folder_);
  lock_.emplace(folder_);
  if (is_elsewhere) {
    ClearFolder(folder_);
    WriteResolvedConfig(run.scenario.params, folder_);
    CopyRecords(run.folder, folder_);
  }
  try {
    train_dynamics::ByteReader checkpoint(run.checkpoint.output);
    const train_dynamics::Bytes bag = checkpoint.Block(), csv = checkpoint.Block();
    const int vehicles = run.scenario.consist.vehicles();
    if (!csv.empty()) csv_ = std::make_unique<CsvRecorder>(folder_, csv, vehicles);
    if (!bag.empty()) bag_ = std::make_unique<BagRecorder>((folder_ / kBag).string(), bag, vehicles);
  } catch (const train_dynamics::SnapshotError& e) {
    throw std::invalid_argument((run.folder / kCheckpointFile).string() + " " + e.what());
  }
  // Both have checked that they can; nothing has been changed so far.
  if (csv_ != nullptr) csv_->GoOn();
  if (bag_ != nullptr) bag_->GoOn();
  if (run.is_branch) WriteFile(folder_ / kBranchFile, TextOf(Encode(run.checkpoint)));
  for (const char* old : {"summary.json", "couplers.csv", "slides.csv", "track_wear.csv", "replay.yaml", "report.html"})
    fs::remove(folder_ / old);
  StartThread();
}

void RunOutput::StartThread() {
  thread_ = std::make_unique<RecorderThread>([this](const train_dynamics::TrainRecord& record) {
    if (bag_ != nullptr) bag_->Record(record);
    if (csv_ != nullptr) csv_->Record(record);
  });
}

template <class Action>
void RunOutput::Attempt(const Action& action) {
  if (error_ != nullptr) return;
  try {
    action();
  } catch (const std::exception& e) {
    if (options_.on_write_error == OnWriteError::kStop) throw;
    error_ = std::current_exception();
    options_.complain(fmt::format("{}: the run goes on without records", e.what()));
  }
}

void RunOutput::Record(const train_dynamics::TrainRecord& record) {
  if (HasRecorder()) Attempt([&] { thread_->Record(record); });
}

bool RunOutput::AskForCheckpoint(train_dynamics::TrainMaster& master, bool wanted) const {
  if (folder_.empty() || checkpoint_exchanges_ == 0 || error_ != nullptr || !master.RecordIsNext()) return false;
  const auto next = static_cast<long>(master.exchange()) + 1;
  if (!wanted && next % checkpoint_exchanges_ != 0 && next != master.exchanges()) return false;
  master.AskForCheckpoint();
  return true;
}

void RunOutput::KeepCheckpoint(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary) {
  Attempt([&] {
    train_dynamics::TrainCheckpoint checkpoint = master.Checkpoint();
    checkpoint.scenario = identity_;
    checkpoint.summary = summary.Memory();
    thread_->Do([this, checkpoint = std::move(checkpoint)]() mutable { LeaveCheckpoint(std::move(checkpoint)); });
  });
}

void RunOutput::LeaveCheckpoint(train_dynamics::TrainCheckpoint checkpoint) {
  if (to_disk_.valid()) to_disk_.get();
  train_dynamics::ByteWriter output;
  output.Add(bag_ != nullptr ? bag_->Checkpoint() : train_dynamics::Bytes());
  output.Add(csv_ != nullptr ? csv_->Checkpoint() : train_dynamics::Bytes());
  checkpoint.output = output.bytes();
  to_disk_ = std::async(std::launch::async, [this, checkpoint = std::move(checkpoint)] {
    if (bag_ != nullptr) bag_->Sync();
    WriteFile(folder_ / kCheckpointFile, TextOf(Encode(checkpoint)));
  });
}

void RunOutput::Finish(const train_dynamics::TrainMaster& master, const train_dynamics::RunSummary& summary,
                       const std::string& summary_json) {
  if (folder_.empty()) return;
  std::exception_ptr error = error_;
  const auto attempt = [&error](const auto& step) {
    try {
      step();
    } catch (const std::exception&) {
      if (error == nullptr) error = std::current_exception();
    }
  };
  attempt([&] { thread_->Finish(); });
  attempt([&] {
    if (to_disk_.valid()) to_disk_.get();
  });
  if (bag_ != nullptr) attempt([&] { bag_->Close(); });
  attempt([&] { WriteFile(folder_ / "summary.json", summary_json); });
  attempt([&] { WriteSlideTables(folder_, summary.slides()); });
  attempt([&] { WriteCouplerTable(folder_, master); });
  attempt([&] { WriteReplay(scenario_, master.schedule(), folder_); });
  if (csv_ != nullptr) attempt([&] { csv_->Close(); });
  if (error != nullptr) std::rethrow_exception(error);
}

}  // namespace train_results
