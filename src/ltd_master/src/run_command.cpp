#include "ltd_master/run_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "ltd_master/bag_recorder.h"
#include "ltd_master/csv_recorder.h"
#include "ltd_master/interrupt.h"
#include "ltd_master/progress.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/config/writer.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/run_summary.h"

namespace ltd_master {
namespace {

namespace fs = std::filesystem;
using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;

LoadedScenario Load(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.model.empty()) overrides.push_back("model=" + options.model);
  return train_dynamics::config::LoadScenario(options.scenario, overrides);
}

/// Writes a whole file or nothing.
void WriteFile(const fs::path& file, const std::string& text) {
  const fs::path unfinished = file.string() + ".unfinished";
  std::ofstream stream(unfinished);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
  fs::rename(unfinished, file);
}

/// The folder of a run's results, cleared of those of an earlier run.
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

int RunScenario(const RunOptions& options) {
  const LoadedScenario scenario = Load(options);
  const fs::path folder = options.out;
  std::unique_ptr<BagRecorder> bag;
  std::unique_ptr<CsvRecorder> csv;
  if (!options.out.empty()) {
    if (fs::exists(folder) && fs::exists(options.scenario) &&
        fs::weakly_canonical(options.scenario).parent_path() == fs::weakly_canonical(folder)) {
      throw std::runtime_error("--out " + options.out +
                               " is the folder of the scenario file: choose another");
    }
    PrepareFolder(folder);
    WriteResolvedConfig(scenario.params, folder);
    bag = std::make_unique<BagRecorder>((folder / "train.bag").string());
    if (options.csv) csv = std::make_unique<CsvRecorder>(folder);
  }

  train_dynamics::InProcessTransport vehicles(scenario.params, scenario.consist, options.threads);
  train_dynamics::TrainMaster master(scenario.params, scenario.consist, vehicles, scenario.pressures);
  train_dynamics::RunSummary summary(scenario.params, scenario.consist);
  Progress progress(scenario.params.duration_s);
  master.AddObserver([&](const TrainRecord& record) { summary.Observe(record); });
  if (bag != nullptr) master.AddObserver([&](const TrainRecord& record) { bag->Record(record); });
  if (csv != nullptr) master.AddObserver([&](const TrainRecord& record) { csv->Record(record); });
  master.AddObserver([&](const TrainRecord& record) { progress.Show(record.time_s, summary.MeanSpeed()); });

  CatchInterrupts();
  std::string fault;
  try {
    master.Start();
    while (!master.Done() && Interrupt() == 0) master.Exchange();
  } catch (const train_dynamics::SimulationFault& e) {
    fault = e.what();
  }

  const std::string json = summary.Json(master, progress.WallSeconds(), fault);
  if (bag != nullptr) bag->Close();
  if (csv != nullptr) csv->Close(master);
  if (!options.out.empty()) WriteFile(folder / "summary.json", json);
  fmt::print("{}", json);
  if (!fault.empty()) {
    fmt::print(stderr, "train_sim: the simulation broke down: {}\n", fault);
    return kSimulationFault;
  }
  if (!master.Done()) {
    fmt::print(stderr, "train_sim: interrupted at {:.3f} s of {:g} s\n", master.time_s(),
               scenario.params.duration_s);
    return kInterrupted;
  }
  return kSuccess;
}

int CheckScenario(const RunOptions& options) {
  const LoadedScenario scenario = Load(options);
  const train_dynamics::ScenarioParams& p = scenario.params;
  const train_dynamics::Consist& consist = scenario.consist;
  double mass = 0.0, length = 0.0;
  for (int i = 0; i < consist.vehicles(); ++i) {
    mass += consist.vehicle(i).TotalMass();
    length += consist.vehicle(i).length_m;
  }
  size_t draw_bars = 0;
  for (int type : consist.connection_type) {
    if (consist.connection_types[type].kind == train_dynamics::ConnectionKind::kDrawBar) ++draw_bars;
  }
  const double steps = static_cast<double>(p.Exchanges()) * p.StepsPerExchange();
  fmt::print("{}: {}\n", p.name, p.description);
  fmt::print("  model      {}\n", train_dynamics::ModelName(p.model));
  fmt::print("  train      {}: {} vehicles, {:.0f} t, {:.1f} m; {} couplers, {} draw-bars\n", p.train.name,
             consist.vehicles(), 1e-3 * mass, length, consist.connection_type.size() - draw_bars, draw_bars);
  fmt::print("  track      {}\n", p.track.name);
  fmt::print("  pressures  {}\n", p.pressure_table.empty()
                                      ? fmt::format("{}, {} driver commands", p.brake.name, p.commands.size())
                                      : p.pressure_table);
  fmt::print(
      "  run        {:g} s from {:g} km/h, {:g} steps of {:g} s, exchange every {:g} s, record every {:g} "
      "s\n",
      p.duration_s, p.initial_speed_kmh, steps, p.dt_s, p.exchange_interval_s, p.record_interval_s);
  return kSuccess;
}

}  // namespace ltd_master
