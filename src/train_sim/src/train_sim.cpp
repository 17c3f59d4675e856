
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "train_console/console.h"
#include "train_sim/brake_commands.h"
#include "train_sim/check_command.h"
#include "train_sim/keys_command.h"
#include "train_sim/new_command.h"
#include "train_sim/route_command.h"
#include "train_sim/run_command.h"
#include "train_sim/vehicle_commands.h"
#include "train_sim/verify_command.h"

namespace {

constexpr const char* kDescription =
    "Simulates the braking of long trains, all vehicles in this process, without a ROS master.\n"
    "\n"
    "  train_sim new my_trains\n"
    "  train_sim run config/scenarios/emergency.yaml --out results/emergency\n"
    "  train_sim run config/scenarios/minimum.yaml --model ltd --set track.grades[0].grade_percent=-1\n"
    "  train_sim run --resume results/emergency\n"
    "  train_sim check my_scenario.yaml\n"
    "  train_sim keys vehicle.brake_rigging\n"
    "  train_sim route my_line.csv --plot my_line.svg\n"
    "  train_sim summary results/emergency\n"
    "  train_sim verify results/emergency\n"
    "  train_sim air-test config/scenarios/full_service_ab.yaml\n"
    "  train_sim brake-weight config/scenarios/mixed_g_p.yaml --set brake=uic_p\n"
    "  train_sim modes config/vehicles/ore_wagon.yaml\n"
    "  train_sim adhesion config/vehicles/ore_wagon.yaml --set wheel_rail.adhesion=wet\n"
    "\n"
    "Exit codes: 0 done; 1 a result could not be written; 2 bad arguments or configuration; 3 the simulation "
    "broke\n"
    "down; 130 interrupted (results so far are saved and marked incomplete). Of verify: 0 the same; 5 different; 6\n"
    "not comparable; 7 the same as far as the recording goes.";

/// A time [s] that is a finite number >= 0. (CLI::NonNegativeNumber takes nan.)
const CLI::Validator kSeconds(
    [](const std::string& text) {
      const std::optional<double> seconds = strict_config::ParseNumber(text);
      return seconds && *seconds >= 0.0 ? "" : "must be a plain number of seconds >= 0, got '" + text + "'";
    },
    "s >= 0");

/// A whole number. (CLI::Range says of 1e3 and 2.5 that they are not in range.)
CLI::Validator Count(int least, int most) {
  return CLI::Validator(
      [least, most](const std::string& text) {
        const std::optional<double> number = strict_config::ParseNumber(text);
        const bool is_whole = number && text.find_first_not_of("0123456789") == std::string::npos;
        return is_whole && least <= *number && *number <= most
                   ? ""
                   : fmt::format("must be a whole number from {} to {} in digits, got '{}'", least, most, text);
      },
      fmt::format("{} to {}", least, most));
}

/// A path. An empty one comes from an unset variable of the shell, and must not lead to loss of data.
const CLI::Validator kPath(
    [](const std::string& text) { return text.empty() ? "is empty: is a variable of the shell not set?" : ""; }, "");

/// Options shared by the commands that read a file and change it.
/// @return the file's option
CLI::Option* AddInput(CLI::App* command, const char* name, const char* help, std::string& file,
                      std::vector<std::string>& overrides) {
  CLI::Option* input = command->add_option(name, file, help)->check(kPath)->required();
  command
      ->add_option("--set", overrides,
                   "replace a value: --set path=value, e.g. train.connection.draft_gear.slack_m=0.02")
      ->allow_extra_args(false);
  return input;
}

/// @throws std::invalid_argument if the command is unknown; names the likely one
void RefuseUnknownCommand(const CLI::App& app, int argc, char** argv) {
  const std::string given = argc > 1 ? argv[1] : "";
  if (given.empty() || given[0] == '-') return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), given) != known.end()) return;
  const std::string nearest = strict_config::Nearest(given, known);
  throw std::invalid_argument("there is no command " + given +
                              (nearest.empty() ? "." : "; did you mean " + nearest + "?") +
                              " Commands: " + strict_config::Join(known, known.size()));
}

/// Lines with the likely option for each unknown one; empty: there is none.
std::string HintsForOptions(const CLI::App& app) {
  std::string hints;
  for (const CLI::App* command : app.get_subcommands()) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command->get_options()) names.push_back(option->get_name());
    for (const std::string& word : command->remaining()) {
      const std::string name = word.substr(0, word.find('='));
      const std::string nearest = name.rfind("--", 0) == 0 ? strict_config::Nearest(name, names) : "";
      if (!nearest.empty()) hints += name + ": did you mean " + nearest + "?\n";
    }
  }
  return hints;
}

int Main(int argc, char** argv) {
  train_sim::RunOptions options;
  std::string vehicle;
  bool table = false;
  std::function<int()> command;

  CLI::App app(kDescription, "train_sim");
  app.set_version_flag("--version", "train_sim " TRAIN_BRAKE_VERSION);
  app.require_subcommand(1);

  CLI::App* run = app.add_subcommand("run", "simulate a scenario, and print the main results");
  AddInput(run, "SCENARIO", "scenario file", options.scenario, options.overrides)->required(false);
  run->add_option("--resume", options.resume,
                  "folder of a run to resume from its checkpoint, instead of a SCENARIO; with --set and another "
                  "--out: a what-if run from there")
      ->check(kPath);
  run->add_option("--checkpoint-interval", options.checkpoint_interval_s,
                  "simulated time [s] between checkpoints in the folder of --out; 0: none")
      ->capture_default_str()
      ->check(kSeconds);
  run->add_flag("--go-on-without-records", options.go_on_without_records,
                "where results cannot be written: run to the end all the same, and end with 1");
  run->add_option("--model", options.model, "vehicle model; default: the scenario's")
      ->check(CLI::IsMember({"2d", "ltd", "ltd-no-inertia"}));
  run->add_option("--out", options.out, "folder for train.bag, config.yaml and summary.json; default: write nothing")
      ->check(kPath);
  run->add_option("--threads", options.threads,
                  "threads; any number gives the same bits; default: one per core for 2d, one for ltd")
      ->check(Count(1, 1024));
  run->add_flag("--csv", options.csv,
                "write tables into the folder, too: couplers, vehicles, history, pressures, wagons");
  run->add_flag("--json", options.json,
                "print the contents of summary.json, for programs, in place of the lines for people");
  run->add_flag("--twin", options.twin,
                "run the train once more with its start speed changed by 1e-9 km/h: the summary says to how many "
                "newtons the maxima are determined");
  run->callback([&] {
    if (options.twin && !options.resume.empty())
      throw CLI::ValidationError("--twin", "is of a run from its start, not of one that is resumed");
    if (options.scenario.empty() == options.resume.empty())
      throw CLI::ValidationError("SCENARIO", "give a scenario, or --resume DIR");
    if (options.csv && !options.resume.empty())
      throw CLI::ValidationError("--csv", "a run is resumed with the tables that it began with");
    if (options.csv && options.out.empty()) throw CLI::ValidationError("--csv", "needs --out DIR to write into");
    command = [&] { return train_sim::RunScenario(options); };
  });

  train_sim::CheckOptions planned;
  CLI::App* check =
      app.add_subcommand("check", "check a scenario with all its parts, print what it is and what a run takes");
  AddInput(check, "SCENARIO", "scenario file", planned.scenario, planned.overrides);
  check->add_option("--model", planned.model, "vehicle model; default: the scenario's")
      ->check(CLI::IsMember({"2d", "ltd", "ltd-no-inertia"}));
  check->add_option("--out", planned.out, "folder for results: is there room for them?")->check(kPath);
  check->add_option("--threads", planned.threads, "as for run")->check(Count(1, 1024));
  check->add_option("--nodes", planned.nodes, "wagon nodes of a distributed run: do they fit?")
      ->check(Count(1, 100000));
  check->add_option("--machines", planned.machines, "machines like this one that share them")
      ->capture_default_str()
      ->check(Count(1, 100000));
  check->add_flag("--json", planned.json, "print one JSON object for programs");
  check->callback([&] { command = [&] { return train_sim::CheckScenario(planned); }; });

  train_sim::CheckOptions resolved;
  CLI::App* resolve = app.add_subcommand(
      "resolve", "print a scenario with its parts, defaults and overrides resolved: YAML that runs again");
  AddInput(resolve, "SCENARIO", "scenario file", resolved.scenario, resolved.overrides);
  resolve->callback(
      [&] { command = [&] { return train_sim::ResolveScenario(resolved.scenario, resolved.overrides); }; });

  train_sim::KeysOptions keys;
  CLI::App* show_keys =
      app.add_subcommand("keys", "print the keys of configuration files: unit, rule, default, meaning, example");
  show_keys->add_option("PATH", keys.path,
                        "which: vehicle, scenario.until, train.connection.slack_m, slack_m; default: all");
  CLI::Option* markdown = show_keys->add_flag("--markdown", keys.markdown, "print docs/configuration.md");
  show_keys->add_option("--json-schema", keys.schema_kind, "print the JSON schema of files of this kind")
      ->type_name("KIND")
      ->excludes(markdown);
  show_keys->add_flag("--results", keys.results, "print docs/result_files.md: what a run leaves")->excludes(markdown);
  show_keys->add_flag("--kinds", keys.kinds, "print the kinds of files, one per line")->excludes(markdown);
  show_keys->callback([&] { command = [&] { return train_sim::PrintKeys(keys); }; });

  std::string folder;
  CLI::App* start_folder = app.add_subcommand(
      "new", "start a folder of one's own with a train, a route, a scenario and a launch file that run");
  start_folder->add_option("FOLDER", folder, "a new or an empty folder")->check(kPath)->required();
  start_folder->callback([&] { command = [&] { return train_sim::StartFolder(folder); }; });

  train_sim::RouteOptions route;
  CLI::App* show_route =
      app.add_subcommand("route", "check a route - a track, a table of its points (CSV) or a scenario's - and draw it");
  AddInput(show_route, "FILE", "track, table or scenario", route.file, route.overrides);
  show_route->add_option("--plot", route.plot, "draw it in this SVG file, over the position")->check(kPath);
  show_route->add_option("--csv", route.csv, "write it to this file as a table of points")->check(kPath);
  show_route->callback([&] { command = [&] { return train_sim::ShowRoute(route); }; });

  train_sim::VerifyOptions recording;
  CLI::App* summary = app.add_subcommand("summary", "tell again what a run came to");
  summary->add_option("DIR", folder, "folder of the run")->check(kPath)->required();
  summary->callback([&] { command = [&] { return train_sim::TellSummary(folder); }; });

  CLI::App* verify = app.add_subcommand("verify", "repeat a recorded run and compare it bit by bit");
  verify->add_option("DIR_OR_BAG", recording.recording, "folder of a run, or bag, also of rosbag record")
      ->check(kPath)
      ->required();
  verify->add_option("--config", recording.config, "scenario of the run; default: the folder's or the bag's own")
      ->check(kPath);
  verify->add_option("--train", recording.train, "namespace of the train, if the bag holds several")->check(kPath);
  verify->add_option("--threads", recording.threads, "threads; any number gives the same bits")->check(Count(1, 1024));
  verify->callback([&] { command = [&] { return train_sim::Verify(recording); }; });

  CLI::App* modes = app.add_subcommand("modes", "natural frequencies of a vehicle's 2D model, largest stable step");
  AddInput(modes, "VEHICLE", "vehicle file", vehicle, options.overrides);
  CLI::Option* with_shapes = modes->add_flag("--csv", table, "comma-separated, with the shapes");
  modes->add_flag("--json", options.json, "print one JSON object for programs")->excludes(with_shapes);
  modes->callback([&] {
    command = [&] {
      using train_sim::ModesFormat;
      const ModesFormat format = options.json ? ModesFormat::kJson : table ? ModesFormat::kCsv : ModesFormat::kText;
      return train_sim::PrintModes(vehicle, options.overrides, format);
    };
  });

  CLI::App* adhesion = app.add_subcommand("adhesion", "wheel-rail adhesion of a vehicle over creepage and speed");
  AddInput(adhesion, "VEHICLE", "vehicle file", vehicle, options.overrides);
  adhesion->add_flag("--csv", table, "comma-separated");
  adhesion->callback([&] { command = [&] { return train_sim::PrintAdhesion(vehicle, options.overrides, table); }; });

  CLI::App* air_test =
      app.add_subcommand("air-test", "test the pneumatic brake of a scenario's train at rest; 1 if a test fails");
  AddInput(air_test, "SCENARIO", "scenario file", vehicle, options.overrides);
  int trials = 0;
  std::uint32_t seed = 1;
  air_test
      ->add_option("--trials", trials,
                   "random sequences of service commands, too, at each of 1, 2, 4 and 8 cells per vehicle: "
                   "no valve may "
                   "go into emergency")
      ->check(Count(0, 1000000));
  air_test->add_option("--seed", seed, "of the random sequences")
      ->check(Count(0, std::numeric_limits<int>::max()))
      ->capture_default_str();
  air_test->callback(
      [&] { command = [&] { return train_sim::PrintAirTest(vehicle, options.overrides, trials, seed); }; });

  CLI::App* brake_weight = app.add_subcommand(
      "brake-weight", "braked-weight percentage of a scenario's vehicles; its train beside the model of ETCS");
  AddInput(brake_weight, "SCENARIO", "scenario file", vehicle, options.overrides);
  brake_weight->callback([&] { command = [&] { return train_sim::PrintBrakeWeight(vehicle, options.overrides); }; });

  RefuseUnknownCommand(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    std::ostringstream output, complaint;
    const int code = app.exit(e, output, complaint);
    complaint << HintsForOptions(app);
    train_console::Print("{}", output.str());
    train_console::Tell("{}", complaint.str());
    return code == 0 ? train_run::kSuccess : train_run::kBadInput;
  }
  return command();
}

}  // namespace

int main(int argc, char** argv) {
  train_console::PrepareProcess();
  try {
    const int exit_code = Main(argc, argv);
    const std::string error = train_console::FinishOutput();
    if (error.empty()) return exit_code;
    train_console::Tell("train_sim: the output could not be written: {}\n", error);
    return exit_code == train_run::kSuccess ? train_run::kFailure : exit_code;
  } catch (const strict_config::Error& e) {
    train_console::Tell("{}\n", e.what());
    return train_run::kBadInput;
  } catch (const std::invalid_argument& e) {
    train_console::Tell("train_sim: {}\n", e.what());
    return train_run::kBadInput;
  } catch (const std::exception& e) {
    train_console::Tell("train_sim: {}\n", e.what());
    return train_run::kFailure;
  }
}
