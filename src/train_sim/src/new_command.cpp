#include "train_sim/new_command.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "train_console/console.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_run/exit_code.h"

namespace train_sim {
namespace {

namespace fs = std::filesystem;

struct Template {
  const char *file, *schema, *text;  ///< schema: its kind for editors, null: none
};

constexpr Template kTemplates[] = {
    {"README.md", nullptr,
     R"(`train_sim check scenarios/stop.yaml` tells what the scenario is and whether it can run.
`train_sim run scenarios/stop.yaml --out results/stop` runs it; `rosrun train_brake report results/stop` draws it.
`rosrun train_brake run scenarios/stop.yaml results/graph` runs it as a ROS graph; )"
     R"(`roslaunch launch/stop.launch` does in a graph of yours.
The train is `trains/mine.yaml`, the route `tracks/mine.csv`; `train_sim route tracks/mine.csv` tells what the route is.
`train_sim keys` prints all keys that these files can have; shipped parts are used by name, as `vehicle: tank`.
)"},
    {"scenarios/stop.yaml", "scenario",
     R"(# A freight train stops on a falling route.
name: stop
description: service brake of a freight train from 60 km/h
model: ltd
train: mine                        # trains/mine.yaml
track: ../tracks/mine.csv
brake: head_end
commands:
  - {time_s: 2, kind: apply, reduction_kpa: 100}
initial_speed_kmh: 60
start_position_m: 3000             # of the first vehicle
initial_slack: stretched
duration_s: 300
until: {standing: true}
)"},
    {"trains/mine.yaml", "train",
     R"(# A locomotive, 12 loaded and 6 empty tank wagons.
name: mine
connection: mt2
consist:
  - {vehicle: sd40_2}
  - {vehicle: tank, count: 12}
  - {vehicle: tank_empty, count: 6}
)"},
    {"tracks/mine.csv", nullptr,
     R"(# A row for each place where something changes; an empty cell changes nothing.
position_m,station,grade_permille,radius_m,speed_limit_kmh
0,Beginning,0,0,80
2000,,-4,0,80
3500,,-4,600,60
4200,,-4,0,80
6000,Middle,0,0,80
12000,End,0,0,80
)"},
    {"launch/stop.launch", nullptr,
     R"(<launch>
  <!-- Runs ../scenarios/stop.yaml. These and all other arguments of train.launch can be given. -->
  <arg name="model" default="ltd" doc="2d, ltd or ltd-no-inertia"/>
  <arg name="vehicles" default="0" doc="vehicles of the train; 0 = all in the master, without wagon nodes"/>
  <arg name="out" default=" " doc="folder for train.bag, config.yaml and summary.json"/>
  <include file="$(find train_brake)/launch/train.launch" pass_all_args="true">
    <arg name="scenario" value="$(dirname)/../scenarios/stop.yaml"/>
  </include>
</launch>
)"},
};

/// The first line with which an editor finds the schema of a file; empty if the schemas are not there.
std::string Modeline(const char* schema) {
  if (schema == nullptr) return "";
  for (const fs::path& root : train_dynamics::config::PartFolders()) {
    std::error_code error;
    const fs::path file = fs::absolute(root / "schema" / (std::string(schema) + ".schema.json"), error);
    if (fs::exists(file, error)) return "# yaml-language-server: $schema=" + file.lexically_normal().string() + "\n";
  }
  return "";
}

[[noreturn]] void Refuse(const fs::path& path, const std::string& why) {
  throw std::invalid_argument(path.string() + " " + why);
}

void WriteFile(const fs::path& file, const std::string& text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) Refuse(file.parent_path(), "cannot be made: " + error.message());
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) Refuse(file, std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace

int StartFolder(const std::string& name) {
  const fs::path folder = name;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) Refuse(folder, "is a file");
  if (fs::is_directory(folder, error) && !fs::is_empty(folder, error))
    Refuse(folder, "is not empty: nothing was written; give a new folder");
  for (const Template& file : kTemplates) WriteFile(folder / file.file, Modeline(file.schema) + file.text);
  train_console::Print("{} has a train, a route, a scenario and a launch file:\n", name);
  for (const Template& file : kTemplates) train_console::Print("  {}\n", (folder / file.file).string());
  train_console::Print("next: train_sim run {} --out {}\n",
                       train_console::ShellWord((folder / "scenarios/stop.yaml").string()),
                       train_console::ShellWord((folder / "results/stop").string()));
  if (train_dynamics::config::PartFolders().empty()) {
    train_console::Tell(
        "train_sim: its parts are shipped ones, which are not found now: source setup.bash of the workspace, "
        "or set "
        "TRAIN_BRAKE_CONFIG to the config folder of train_brake\n");
  }
  return train_run::kSuccess;
}

}  // namespace train_sim
