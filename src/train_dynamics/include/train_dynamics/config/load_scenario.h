#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/train/scenario.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics::config {

/// The folders in which parts are looked for besides those around a file: those that the environment variable
/// TRAIN_BRAKE_CONFIG lists, separated by ':'.
std::vector<std::filesystem::path> PartFolders();

/// A scenario that is ready to run.
struct LoadedScenario {
  ScenarioParams params;
  Consist consist;
  BrakeSystem pressures;
  std::vector<std::string> warnings;           ///< see Warnings(); "file:line: sentence"
  std::vector<std::filesystem::path> files{};  ///< all that were read
  /// Largest stable dt_s of each kind of vehicle, by its name [s]; 2D model only.
  std::vector<std::pair<std::string, double>> stable_steps{};
};

/// Reads a scenario with all of its parts, and its pressure table if it names one.
///
/// Beyond the rules of ScenarioParams, a 2D scenario must have vehicles from which a Wagon can be built and which rest
/// on their springs, and a dt_s within the largest stable step of each (AnalyseModes).
///
/// A relative path of the pressure table counts from the folder of the file that names it, or from the
/// working directory where an override does. The table is CSV with the columns time_s, vehicle_1_pa,
/// vehicle_2_pa, ... , one for each vehicle of the train. Parts are looked for around the file, then in the
/// folders of the environment variable TRAIN_BRAKE_CONFIG.
///
/// @param overrides  "path=value", as given to --set
/// @throws Error with everything that is wrong, as file:line: key ...
LoadedScenario LoadScenario(const std::string& file, const std::vector<std::string>& overrides);

/// Reads a self-contained scenario from a text, such as Write makes; it must not name a pressure table.
/// @param label  what messages name instead of a file
/// @throws Error
LoadedScenario LoadScenarioText(const std::string& text, const std::string& label);

/// Reads the track of a file: one of a track, a table of its points (CSV), or a scenario that has one.
TrackParams LoadTrack(const std::string& file, const std::vector<std::string>& overrides);

/// Reads a vehicle file in the same manner; checks that a Wagon can be built from it.
VehicleParams LoadVehicle(const std::string& file, const std::vector<std::string>& overrides);

}  // namespace train_dynamics::config
