#include "train_dynamics/config/load_scenario.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "strict_config/csv_table.h"
#include "strict_config/reader.h"
#include "strict_config/suggestion.h"
#include "strict_config/writer.h"
#include "train_dynamics/brake/pressure_table.h"
#include "train_dynamics/config/plausible.h"
#include "train_dynamics/contact/kalker.h"
#include "train_dynamics/train/scenario_warnings.h"
#include "train_dynamics/vehicle/wagon_modes.h"

namespace train_dynamics::config {
namespace {

using strict_config::CsvTable;
using strict_config::Error;
using strict_config::ErrorList;
using strict_config::Load;
using strict_config::LoadOptions;
using strict_config::LoadText;
using strict_config::ReadCsvTable;
using strict_config::Reader;
using strict_config::Write;

/// The environment variable that lists folders of parts.
constexpr const char* kPartsVariable = "TRAIN_BRAKE_CONFIG";

LoadOptions OptionsFor(const std::vector<std::string>& overrides, const std::string& kind) {
  LoadOptions options;
  options.search_roots = PartFolders();
  options.search_remedy = std::string("set ") + kPartsVariable + " to the config folder of train_brake";
  options.overrides = overrides;
  options.kind = kind;
  options.plausible_size = PlausibleSize;
  return options;
}

/// Throws what has been collected, if anything.
void ThrowIfAny(const ErrorList& errors) {
  if (!errors.empty()) throw Error(errors);
}

std::string PressureColumn(int vehicle) { return "vehicle_" + std::to_string(vehicle) + "_pa"; }

/// The columns of a table of pressures that a train of so many vehicles does not use.
std::vector<std::string> UnusedColumns(const CsvTable& table, int vehicles) {
  std::set<std::string> used = {"time_s"};
  for (int i = 1; i <= vehicles; ++i) used.insert(PressureColumn(i));
  std::vector<std::string> unused;
  for (const std::string& name : table.columns) {
    if (used.count(name) == 0) unused.push_back(name);
  }
  return unused;
}

/// Warns where a table of pressures and the run do not cover each other.
void WarnOfCover(const CsvTable& table, const std::vector<double>& time_s, int vehicles, double duration_s,
                 std::vector<std::string>& warnings) {
  using strict_config::ShortestDecimal;
  const auto warn = [&](const std::string& text) { warnings.push_back(table.file + ": " + text); };
  if (time_s.front() > 0.0) {
    warn("begins at " + ShortestDecimal(time_s.front()) +
         " s: until then the pressures of its first row hold, from time 0 on");
  }
  if (time_s.back() < duration_s) {
    warn("ends at " + ShortestDecimal(time_s.back()) + " s of " + ShortestDecimal(duration_s) +
         " s: from then on the pressures of its last row hold");
  }
  const std::size_t unused = UnusedColumns(table, vehicles).size();
  if (unused > 0) {
    warn(std::to_string(unused) + " of its columns are not used: the train has " + std::to_string(vehicles) +
         (vehicles == 1 ? " vehicle" : " vehicles"));
  }
}

BrakeSystem ReadPressureTable(const std::string& file, int vehicles, double duration_s,
                              std::vector<std::string>& warnings) {
  ErrorList errors;
  const CsvTable table = ReadCsvTable(file, errors);
  ThrowIfAny(errors);
  const std::vector<double>* time = table.Column("time_s", errors);
  const auto column_of = [&](int vehicle) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), PressureColumn(vehicle));
    return found == table.columns.end() ? nullptr : &table.values[found - table.columns.begin()];
  };
  std::vector<std::vector<double>> pressures;
  std::vector<std::string> missing;
  for (int i = 1; i <= vehicles; ++i) {
    if (const std::vector<double>* column = column_of(i)) {
      pressures.push_back(*column);
    } else {
      missing.push_back(PressureColumn(i));
    }
  }
  if (!missing.empty()) {
    constexpr std::size_t kListed = 3;
    const std::vector<std::string> others = UnusedColumns(table, vehicles);
    errors.Add(table.file, table.header_line, "",
               "has no column" + std::string(missing.size() == 1 ? " " : "s ") + strict_config::Join(missing, kListed) +
                   ": of " + std::to_string(vehicles) + " vehicles " + std::to_string(missing.size()) +
                   " have no pressures" +
                   (others.empty() ? "" : "; not used: " + strict_config::Join(others, kListed)));
  }
  ThrowIfAny(errors);
  const auto complain = [&](std::size_t row, const std::string& key, double value, const std::string& rule) {
    errors.Add(table.file, table.row_lines[row], key, rule + ", got " + strict_config::ShortestDecimal(value));
  };
  for (std::size_t row = 0; row < time->size(); ++row) {
    if (row > 0 && (*time)[row] <= (*time)[row - 1]) {
      complain(row, "time_s", (*time)[row],
               "must be later than that of the row before, " + strict_config::ShortestDecimal((*time)[row - 1]) + " s");
    }
    constexpr double kLargest = 3e6;  // see PlausibleSize
    for (int i = 0; i < vehicles; ++i) {
      const double pressure_pa = pressures[static_cast<std::size_t>(i)][row];
      if (pressure_pa >= 0.0 && pressure_pa <= kLargest) continue;
      complain(row, PressureColumn(i + 1), pressure_pa, "must be in [0, 3000000] Pa");
    }
  }
  ThrowIfAny(errors);
  WarnOfCover(table, *time, vehicles, duration_s, warnings);
  return BrakeSystem(PressureTable(*time, std::move(pressures)));
}

/// Whether a vehicle has a 2D model that can rest; if not, reports which of its parameters prevent it.
/// @param path  of the vehicle with a dot at its end; empty for the root
bool MakesWagon(const VehicleParams& vehicle, const std::string& path, Reader& rules) {
  if (vehicle.IsOneMass()) {
    rules.Check(false, path + "mass_kg", "is all that the vehicle has: without bodies it has no 2D model");
    return false;
  }
  const HertzParams& hertz = vehicle.wheel_rail.hertz;
  const double radius_m = vehicle.wheelset.wheel_radius_m;
  struct Step {
    const char *key, *complaint;
    std::function<void()> build;
  };
  const std::string no_contact = "gives no contact with wheelset.wheel_radius_m " + ShortestDecimal(radius_m);
  const Step steps[] = {
      {"wheel_rail.hertz", no_contact.c_str(),
       [&] {
         const ContactEllipse ellipse = HertzEllipse(hertz, radius_m);
         KalkerC11(ellipse.a_per_cbrt_n / ellipse.b_per_cbrt_n, hertz.poisson_ratio);
       }},
      {"wheel_rail", "makes no wagon", [&] { WithBogieVehicle(vehicle, [](const auto& /*wagon*/) {}); }},
      {"spring_nest", "cannot be used",
       [&] { WithBogieVehicle(vehicle, [](const auto& wagon) { StaticEquilibrium(wagon, 0.0, 0.0); }); }},
  };
  for (const Step& step : steps) {
    try {
      step.build();
    } catch (const std::exception& error) {
      rules.Check(false, path + step.key, std::string(step.complaint) + ": " + error.what());
      return false;
    }
  }
  return true;
}

/// A number >= 0 rounded down to three digits.
std::string RoundedDown(double value) {
  if (!(value > 0.0)) return "0";
  double unit = 1.0;
  while (unit > 0.01 * value) unit *= 0.1;
  char text[32];
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, std::floor(value / unit) * unit, std::chars_format::general, 3);
  return std::string(text, end.ptr);
}

/// The largest stable step of each kind of vehicle of the 2D model.
std::vector<std::pair<std::string, double>> JudgeWagons(const ScenarioParams& scenario, Reader& rules) {
  std::vector<std::pair<std::string, double>> stable_steps;
  std::set<std::string> judged;
  for (std::size_t i = 0; i < scenario.train.consist.size(); ++i) {
    if (scenario.ModelOfGroup(i) != VehicleModel::kTwoD) continue;
    const VehicleParams& vehicle = scenario.train.consist[i].vehicle;
    if (!judged.insert(Write(vehicle)).second) continue;
    const std::string path = "train.consist[" + std::to_string(i) + "].vehicle";
    if (!MakesWagon(vehicle, path + ".", rules)) continue;
    const double stable_step_s =
        WithBogieVehicle(vehicle, [](const auto& wagon) { return AnalyseModes(wagon).largest_stable_step_s; });
    stable_steps.emplace_back(vehicle.name.empty() ? path : vehicle.name, stable_step_s);
  }
  const auto stiffest = std::min_element(stable_steps.begin(), stable_steps.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
  if (stiffest != stable_steps.end()) {
    rules.Check(scenario.dt_s <= stiffest->second, "dt_s",
                "must be at most " + RoundedDown(stiffest->second) + ", the largest stable step of vehicle " +
                    stiffest->first + " (train_sim modes)");
  }
  return stable_steps;
}

/// Whether a file holds a scenario and not one of its parts.
bool IsScenario(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".csv") return false;
  ErrorList unread;
  const strict_config::NodePtr root = strict_config::PartLibrary({}, unread).Open(file, "");
  if (!root) return false;
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  return folder.filename() == "scenarios" || root->Find("train") || root->Find("track") || root->Find("duration_s");
}

}  // namespace

std::vector<std::filesystem::path> PartFolders() { return strict_config::FoldersInEnvironment(kPartsVariable); }

LoadedScenario LoadScenario(const std::string& file, const std::vector<std::string>& overrides) {
  std::optional<Consist> consist;
  std::optional<BrakeSystem> pressures;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, double>> stable_steps;
  const auto judge = [&](ScenarioParams& params, Reader& rules) {
    files = rules.Files();
    stable_steps = JudgeWagons(params, rules);
    warnings.assign(rules.Ambiguities().begin(), rules.Ambiguities().end());
    for (const Warning& warning : Warnings(params)) {
      warnings.push_back(rules.PlaceOf(warning.key) + ": " + warning.text);
    }
    consist.emplace(params.train);
    if (!params.pressure_table.empty()) {
      params.pressure_table = (rules.FolderOf("pressure_table") / params.pressure_table).lexically_normal();
      return;
    }
    try {
      pressures = MakeBrakeSystem(params, *consist);
    } catch (const std::invalid_argument& error) {
      rules.Check(false, "brake", std::string("does not suit the train: ") + error.what());
    }
  };
  ErrorList errors;
  ScenarioParams params = Load<ScenarioParams>(file, OptionsFor(overrides, "scenarios"), errors, judge);
  ThrowIfAny(errors);
  if (!params.pressure_table.empty()) {
    pressures = ReadPressureTable(params.pressure_table, consist->vehicles(), params.duration_s, warnings);
    files.emplace_back(params.pressure_table);
  }
  return {std::move(params),   std::move(*consist), std::move(*pressures),
          std::move(warnings), std::move(files),    std::move(stable_steps)};
}

LoadedScenario LoadScenarioText(const std::string& text, const std::string& label) {
  ErrorList errors;
  ScenarioParams params = LoadText<ScenarioParams>(text, label, errors);
  if (!params.pressure_table.empty()) errors.Add(label, 0, "pressure_table", "names a file, which is not at hand");
  ThrowIfAny(errors);
  Consist consist(params.train);
  try {
    BrakeSystem pressures = MakeBrakeSystem(params, consist);
    return {std::move(params), std::move(consist), std::move(pressures), {}};
  } catch (const std::invalid_argument& error) {
    errors.Add(label, 0, "brake", std::string("does not suit the train: ") + error.what());
    throw Error(errors);
  }
}

TrackParams LoadTrack(const std::string& file, const std::vector<std::string>& overrides) {
  if (IsScenario(file)) return LoadScenario(file, overrides).params.track;
  ErrorList errors;
  TrackParams track = Load<TrackParams>(file, OptionsFor(overrides, "tracks"), errors);
  ThrowIfAny(errors);
  if (track.name.empty()) track.name = std::filesystem::path(file).stem().string();
  return track;
}

VehicleParams LoadVehicle(const std::string& file, const std::vector<std::string>& overrides) {
  ErrorList errors;
  VehicleParams vehicle =
      Load<VehicleParams>(file, OptionsFor(overrides, "vehicles"), errors,
                          [](VehicleParams& params, Reader& rules) { MakesWagon(params, "", rules); });
  ThrowIfAny(errors);
  return vehicle;
}

}  // namespace train_dynamics::config
