#include "train_sim/verify_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/run_summary.h"
#include "train_results/conversions.h"
#include "train_results/plain_file.h"
#include "train_results/recorded_message.h"
#include "train_results/recorded_run.h"
#include "train_results/resume.h"
#include "train_run/interrupt.h"
#include "train_run/progress.h"
#include "train_run/train_run.h"
#include "train_sim/run_command.h"

namespace train_sim {
namespace {

namespace fs = std::filesystem;
using train_dynamics::ScenarioParams;
using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;
using train_results::Compare;
using train_results::Difference;
using train_results::RecordedRun;
using train_results::RecordedTopic;

fs::path BagOf(const fs::path& recording) {
  if (!fs::exists(recording)) throw train_results::UnreadableBag("there is no such file or folder");
  if (!fs::is_directory(recording)) return recording;
  if (fs::exists(recording / "train.bag")) return recording / "train.bag";
  if (fs::exists(recording / "train.bag.active")) return recording / "train.bag.active";  // of a run that was cut off
  throw train_results::UnreadableBag("the folder holds no train.bag");
}

constexpr std::size_t kLargestConfig = 1 << 26;

fs::path FolderOf(const fs::path& recording) {
  return fs::is_directory(recording) ? recording : recording.parent_path();
}

/// Whether the files in its folder belong to the same run: a folder of results, or the bag in it.
bool IsOfARun(const fs::path& recording) { return fs::is_directory(recording) || recording.filename() == "train.bag"; }

/// A scenario without its comments and without the place of its pressure table, which a run copies beside its
/// config.yaml.
std::string WithoutPlaces(const std::string& scenario) {
  std::istringstream lines(scenario);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind('#', 0) != 0 && line.rfind("pressure_table:", 0) != 0) kept += line + '\n';
  }
  return kept;
}

/// The scenario of the run: the folder's config.yaml, or the one in the bag, or the config.yaml beside the bag.
LoadedScenario ScenarioOf(const VerifyOptions& options, RecordedRun& recorded) {
  using train_dynamics::config::LoadScenario;
  if (!options.config.empty()) return LoadScenario(options.config, {});
  const fs::path beside = FolderOf(options.recording) / "config.yaml";
  const std::optional<std::string> within = recorded.Scenario();
  // A folder's config.yaml may name files beside it, which a bag cannot hold; so it is used if it is still the run's.
  // (The bag of a branch begins with the other run's scenario.)
  const bool is_beside = IsOfARun(options.recording) && fs::exists(beside);
  const bool is_branch = fs::exists(FolderOf(options.recording) / train_results::kBranchFile);
  if (within && is_beside && !is_branch &&
      WithoutPlaces(*within) != WithoutPlaces(train_results::ReadPlainFile(beside, kLargestConfig))) {
    train_console::Tell("warning: {} is not the scenario that the bag holds, which is repeated\n", beside.string());
    return train_dynamics::config::LoadScenarioText(*within, "the scenario in the bag");
  }
  if (within && !is_beside) {
    return train_dynamics::config::LoadScenarioText(*within, "the scenario in the bag");
  }
  if (fs::exists(beside)) return LoadScenario(beside.string(), {});
  throw train_results::UnreadableBag(
      "the bag does not hold its scenario, and there is no config.yaml beside it; give it with --config");
}

/// The checkpoint at which a branch left the other run, if it is one.
std::optional<train_dynamics::TrainCheckpoint> BranchOf(const fs::path& recording) {
  const fs::path file = FolderOf(recording) / train_results::kBranchFile;
  if (!fs::exists(file)) return std::nullopt;
  return train_results::ReadCheckpoint(file);
}

/// The vehicles that the bag shows in full detail, from 1.
std::vector<int> WagonsIn(RecordedRun& recorded, int vehicles) {
  std::vector<int> wagons;
  for (int i = 0; i < vehicles; ++i) {
    if (recorded.wagon(train_dynamics::VehicleName(i, vehicles)) != nullptr) wagons.push_back(i + 1);
  }
  return wagons;
}

/// Compares the records of a repetition with those of the bag, until one differs or the bag ends.
class Comparison {
 public:
  Comparison(RecordedRun& recorded, int vehicles) : recorded_(recorded), vehicles_(vehicles) {}

  /// Skips the bag's messages up to the checkpoint with which the repetition begins.
  void BeginAt(const train_dynamics::TrainCheckpoint& checkpoint, const ScenarioParams& params);

  /// An observer of the repetition's TrainMaster.
  void Observe(const TrainRecord& record);

  bool Differs() const { return !differences_.empty(); }
  bool Finished() const { return Differs() || recorded_.state().done(); }
  long records() const { return records_; }  ///< that are the same
  /// Messages of other topics that are missing beside those of the state, as text; empty: none.
  std::string Missing() const;
  /// The first record that differs, the vehicle and the quantity.
  std::string Verdict() const;

 private:
  template <class Message, class Make>
  void Check(RecordedTopic* topic, const TrainRecord& record, Message& message, const Make& make);
  void CheckWagons(const TrainRecord& record);

  RecordedRun& recorded_;
  const int vehicles_;
  long records_ = 0;
  bool is_recorded_ = false;    ///< the state at the last record
  double time_s_ = 0.0;         ///< of the last record
  std::uint64_t exchange_ = 0;  ///< of the last record
  std::vector<Difference> differences_;
  std::map<std::string, long> missing_;  ///< messages, by topic

  train_brake_msgs::TrainState state_;
  train_brake_msgs::InTrainForces forces_;
  train_brake_msgs::BrakePressures pressures_;
  train_brake_msgs::EnergyLedger ledger_;
  train_brake_msgs::Slides slides_;
  train_brake_msgs::WagonState wagon_;
};

/// Compares what the topic has about this record with the message that `make` fills, if one is due.
template <class Message, class Make>
void Comparison::Check(RecordedTopic* topic, const TrainRecord& record, Message& message, const Make& make) {
  if (topic == nullptr) return;
  const bool is_there = !topic->done() && topic->exchange() <= record.exchange;
  if (!is_there && is_recorded_ && make(message)) ++missing_[topic->name()];
  for (; !topic->done() && topic->exchange() <= record.exchange; topic->Advance()) {
    if (topic->exchange() == record.exchange && make(message)) {
      const std::vector<Difference> found = Compare(topic->message(), message);
      differences_.insert(differences_.end(), found.begin(), found.end());
    } else {
      differences_.push_back({0, "",
                              fmt::format("{} has a message of exchange {}, of which there is none now", topic->name(),
                                          topic->exchange())});
    }
  }
}

void Comparison::CheckWagons(const TrainRecord& record) {
  for (const train_dynamics::WagonDetail& detail : record.vehicles.details) {
    Check(recorded_.wagon(train_dynamics::VehicleName(detail.vehicle, vehicles_)), record, wagon_, [&](auto& message) {
      train_results::Convert(record, detail, message);
      return true;
    });
  }
}

void Comparison::BeginAt(const train_dynamics::TrainCheckpoint& checkpoint, const ScenarioParams& params) {
  std::vector<RecordedTopic*> topics = {&recorded_.state(), recorded_.forces(), recorded_.pressures(),
                                        recorded_.ledger(), recorded_.slides()};
  for (const int vehicle : params.detail_vehicles) {
    topics.push_back(recorded_.wagon(train_dynamics::VehicleName(vehicle - 1, vehicles_)));
  }
  for (RecordedTopic* topic : topics) {
    while (topic != nullptr && !topic->done() && topic->exchange() <= checkpoint.exchange) topic->Advance();
  }
}

void Comparison::Observe(const TrainRecord& record) {
  if (Finished()) return;
  const auto convert = [&](auto& message) {
    train_results::Convert(record, message);
    return true;
  };
  time_s_ = record.time_s;
  exchange_ = record.exchange;
  is_recorded_ = recorded_.state().exchange() == record.exchange;
  CheckWagons(record);
  Check(&recorded_.state(), record, state_, convert);
  Check(recorded_.pressures(), record, pressures_, convert);
  Check(recorded_.forces(), record, forces_, convert);
  Check(recorded_.ledger(), record, ledger_, [&](auto& message) {
    if (record.ledger) train_results::Convert(record, message);
    return record.ledger.has_value();
  });
  Check(recorded_.slides(), record, slides_, [&](auto& message) {
    if (!record.slides.empty()) train_results::Convert(record, message);
    return !record.slides.empty();
  });
  if (is_recorded_ && !Differs()) ++records_;
}

std::string Comparison::Missing() const {
  std::string text;
  for (const auto& [topic, count] : missing_) {
    text += fmt::format("  not in the bag: {} message(s) of {}\n", count, topic);
  }
  return text;
}

std::string Comparison::Verdict() const {
  const auto is_digest = [](const Difference& each) {
    return each.quantity == "vehicle_digest" || each.quantity == "state_digest";
  };
  const auto is_vehicle = [](const Difference& each) { return each.quantity == "vehicle_digest"; };
  const auto first = std::find_if(differences_.begin(), differences_.end(), is_vehicle);
  const int vehicle = first == differences_.end() ? 0 : first->vehicle;
  const auto value = std::find_if(differences_.begin(), differences_.end(), [&](const Difference& each) {
    return !is_digest(each) && (vehicle == 0 || each.vehicle == vehicle);
  });
  std::string what = "the chain of digests, but no recorded value: the memory of a draft gear, or an earlier record";
  if (value != differences_.end()) {
    what = value->text;
  } else if (vehicle > 0) {
    what = fmt::format("vehicle {}: its state, but no recorded value (detail_vehicles: [{}] records them all)", vehicle,
                       vehicle);
  }
  return fmt::format(
      "different: the first record that differs is that of {:g} s (exchange {})\n"
      "  {}\n"
      "  {} of {} vehicles differ in it; the {} records before it are the same\n",
      time_s_, exchange_, what, std::count_if(differences_.begin(), differences_.end(), is_vehicle), vehicles_,
      records_);
}

/// The digest in the summary.json of a whole run, where the recording is such a run's; else nothing.
/// @throws train_results::UnreadableBag if summary.json is not the summary of a run
std::optional<std::string> DigestInSummary(const fs::path& recording) {
  const fs::path file = FolderOf(recording) / "summary.json";
  if (!IsOfARun(recording) || !fs::exists(file)) return std::nullopt;
  const auto refusal = [&file](const std::string& why) {
    return train_results::UnreadableBag(file.string() + " " + why);
  };
  nlohmann::json summary;
  try {
    summary = nlohmann::json::parse(train_results::ReadPlainFile(file, 1 << 20));
  } catch (const nlohmann::json::exception& e) {
    throw refusal(std::string("is not JSON: ") + e.what());
  }
  if (!summary.is_object()) throw refusal("must hold a JSON object, the summary of a run");
  const auto complete = summary.find("complete"), digest = summary.find("state_digest");
  if (complete == summary.end() || !complete->is_boolean()) throw refusal("must say complete: true or false");
  if (digest == summary.end() || !digest->is_string()) throw refusal("must have a state_digest, a text");
  return *complete ? std::make_optional(digest->get<std::string>()) : std::nullopt;
}

int Repeat(const VerifyOptions& options, RecordedRun& recorded) {
  const std::optional<std::string> summarised = DigestInSummary(options.recording);
  LoadedScenario scenario = ScenarioOf(options, recorded);
  if (const auto external = train_dynamics::ExternalRanks(scenario.params.train); !external.empty()) {
    throw train_results::UnreadableBag(
        fmt::format("{}{} external, and only the node {} can move them again: run {} with it once more, and compare "
                    "state_digest in summary.json",
                    VehiclesText(external.front()),
                    external.size() > 1          ? " and others are"
                    : external.front().count > 1 ? " are"
                                                 : " is",
                    external.front().name, recorded.LiveCommands().empty() ? "config.yaml" : "replay.yaml"));
  }
  scenario.params.detail_vehicles = WagonsIn(recorded, scenario.consist.vehicles());
  const ScenarioParams& params = scenario.params;
  train_dynamics::InProcessTransport vehicles(params, scenario.consist, Threads(options.threads, scenario));
  Comparison comparison(recorded, scenario.consist.vehicles());
  const std::optional<train_dynamics::TrainCheckpoint> branch = BranchOf(options.recording);
  const std::uint64_t first = branch ? branch->exchange : 0;
  train_run::TrainRun run(params, scenario.consist, vehicles, scenario.pressures, branch ? &*branch : nullptr);
  const train_dynamics::TrainMaster& master = run.master();
  train_run::Progress progress(params.duration_s, run.start_s());
  run.AddObserver([&](const TrainRecord& record) { comparison.Observe(record); });
  run.AddObserver([&](const TrainRecord& record) { progress.Show(record.time_s, record.mean_speed_mps); });

  train_run::CatchInterrupts();
  if (branch) comparison.BeginAt(*branch, params);
  train_run::RunHooks hooks;
  // Live commands are given again, each at its exchange; those that a branch took over are in its checkpoint.
  const std::vector<train_dynamics::DriverCommand> live = recorded.LiveCommands();
  std::size_t next_live = 0;
  while (next_live < live.size() && *live[next_live].exchange < static_cast<double>(first)) ++next_live;
  hooks.begins = [&] {
    for (; next_live < live.size() && *live[next_live].exchange <= static_cast<double>(master.exchange()); ++next_live)
      run.Command(live[next_live]);
  };
  hooks.ends = [&] { return comparison.Finished() || train_run::Interrupt() != 0; };
  run.Go(hooks);
  progress.Finish();

  if (comparison.Differs()) {
    train_console::Print("{}", comparison.Verdict());
    return train_run::kDifferent;
  }
  if (!run.fault().empty()) {
    train_console::Print("different: the repeated run failed where the recorded run continued: {}\n", run.fault());
    return train_run::kDifferent;
  }
  if (!comparison.Finished()) {
    if (train_run::Interrupt() == 0) {
      train_console::Print("different: the bag goes on after the end at {:g} s\n", params.duration_s);
      return train_run::kDifferent;
    }
    train_console::Print("interrupted at {:g} s of {:g} s: the same so far\n", master.time_s(), params.duration_s);
    return train_run::kInterrupted;
  }
  const long end = master.EndedByUntil() ? static_cast<long>(master.exchange()) : params.Exchanges();  // of the run
  const long all = (end - static_cast<long>(first)) / params.ExchangesPerRecord() + (branch ? 0 : 1);
  const char* const covered = comparison.records() < all ? "; the digest covers those that are not in the bag" : "";
  if (!master.Done()) {
    train_console::Print("incomplete: the bag ends at {:g} s of {:g} s; the same so far, {} records\n", master.time_s(),
                         params.duration_s, comparison.records());
    return train_run::kIncomplete;
  }
  const std::string digest = fmt::format("{:016x}", master.state_digest());
  if (summarised && *summarised != digest) {
    train_console::Print("different: the records are the same, but summary.json has the digest {}, now it is {}\n",
                         *summarised, digest);
    return train_run::kDifferent;
  }
  const std::string begin = branch ? fmt::format("from {:g} s, where it left another run, ", run.start_s()) : "";
  train_console::Print("same: {} of {} records of {} vehicles {}to {:g} s, digest {}{}\n{}", comparison.records(), all,
                       scenario.consist.vehicles(), begin, master.time_s(), digest, covered, comparison.Missing());
  return train_run::kSuccess;
}

/// "train_brake 0.1.0": the program that recorded a run, by its bag or the summary.json beside it; empty if neither has
/// it.
std::string WriterOf(const fs::path& recording) {
  try {
    const std::string writer = train_results::WriterOf(BagOf(recording));
    const fs::path summary = FolderOf(recording) / "summary.json";
    if (!writer.empty() || !IsOfARun(recording) || !fs::exists(summary)) return writer;
    const auto json = nlohmann::json::parse(train_results::ReadPlainFile(summary, 1 << 20));
    return "train_brake " + json.at("version").get<std::string>();
  } catch (const std::exception&) {
    return "";  // their errors have been reported
  }
}

/// Says how to handle a recording of another version.
void TellWriter(const std::string& recording) {
  const std::string writer = WriterOf(recording), own = "train_brake " TRAIN_BRAKE_VERSION;
  if (writer.empty() || writer == own) return;
  train_console::Tell(
      "train_sim: {} was written by {}, this is {}: other versions may give other bits; verify it with the "
      "version that wrote it\n",
      recording, writer, own);
}

}  // namespace

int Verify(const VerifyOptions& options) {
  try {
    RecordedRun recorded(BagOf(options.recording), options.train);
    const int code = Repeat(options, recorded);
    if (code == train_run::kDifferent) TellWriter(options.recording);
    return code;
  } catch (const std::exception& e) {
    train_console::Tell("train_sim: {} cannot be verified: {}\n", options.recording, e.what());
    TellWriter(options.recording);
    return train_run::kUnreadable;
  }
}

}  // namespace train_sim
