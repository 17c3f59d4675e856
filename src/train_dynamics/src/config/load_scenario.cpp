#include "train_dynamics/config/load_scenario.h"

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "train_dynamics/brake/pressure_table.h"
#include "train_dynamics/config/csv_table.h"
#include "train_dynamics/config/reader.h"

namespace train_dynamics::config {
namespace {

LoadOptions OptionsFor(const std::vector<std::string>& overrides, const std::string& kind) {
  LoadOptions options;
  options.search_roots = SearchRootsFromEnvironment();
  options.overrides = overrides;
  options.kind = kind;
  return options;
}

/// Throws what has been collected, if anything.
void ThrowIfAny(const ErrorList& errors) {
  if (!errors.empty()) throw Error(errors);
}

PressureSource ReadPressureTable(const std::string& file, int vehicles) {
  ErrorList errors;
  const CsvTable table = ReadCsvTable(file, errors);
  ThrowIfAny(errors);
  const std::vector<double>* time = table.Column("time_s", errors);
  std::vector<std::vector<double>> pressures;
  for (int i = 1; i <= vehicles; ++i) {
    const std::vector<double>* column = table.Column("vehicle_" + std::to_string(i) + "_pa", errors);
    if (column != nullptr) pressures.push_back(*column);
  }
  ThrowIfAny(errors);
  try {
    const auto source = std::make_shared<const PressureTable>(*time, std::move(pressures));
    return [source](double time_s, std::vector<double>& pressure_pa) {
      source->PressuresAt(time_s, pressure_pa);
    };
  } catch (const std::invalid_argument& e) {
    errors.Add(file, 0, "", e.what());
    throw Error(errors);
  }
}

}  // namespace

LoadedScenario LoadScenario(const std::string& file, const std::vector<std::string>& overrides) {
  ErrorList errors;
  ScenarioParams params = Load<ScenarioParams>(file, OptionsFor(overrides, "scenarios"), errors);
  ThrowIfAny(errors);
  Consist consist(params.train);
  try {
    if (!params.pressure_table.empty()) {
      const std::filesystem::path folder = std::filesystem::path(file).parent_path();
      params.pressure_table = (folder / params.pressure_table).string();
      PressureSource table = ReadPressureTable(params.pressure_table, consist.vehicles());
      return {std::move(params), std::move(consist), std::move(table)};
    }
    PressureSource brake = AirBrakePressures(params, consist);
    return {std::move(params), std::move(consist), std::move(brake)};
  } catch (const std::invalid_argument& e) {
    errors.Add(file, 0, "brake", e.what());
    throw Error(errors);
  }
}

VehicleParams LoadVehicle(const std::string& file, const std::vector<std::string>& overrides) {
  return Load<VehicleParams>(file, OptionsFor(overrides, "vehicles"));
}

}  // namespace train_dynamics::config
