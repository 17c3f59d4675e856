// What a scenario is refused for before it runs, and what it is warned of; the texts included.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/reader.h"
#include "strict_config/validate.h"
#include "strict_config/writer.h"
#include "train_dynamics/config/load_scenario.h"

namespace train_dynamics::config {
namespace {

using strict_config::Error;
using strict_config::ErrorList;
using strict_config::Validate;

namespace fs = std::filesystem;
using Settings = std::vector<std::string>;

class ScenarioRules : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rules_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = fs::canonical(pattern);
    fs::copy(TRAIN_BRAKE_CONFIG_DIR, root_, fs::copy_options::recursive);
  }
  void TearDown() override { fs::remove_all(root_); }

  std::string Scenario(const std::string& name) const { return (root_ / "scenarios" / name).string() + ".yaml"; }

  std::string Put(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
    return (root_ / name).string();
  }

  /// The complaints about a scenario, without the folder; empty if it is right.
  std::string ErrorsOf(const std::string& file, const Settings& settings = {}) const {
    try {
      LoadScenario(file, settings);
    } catch (const Error& error) {
      return WithoutFolder(error.what());
    }
    return "";
  }
  /// The warnings about one of the scenarios, one per line.
  std::string WarningsOf(const std::string& name, const Settings& settings = {}) const {
    std::string text;
    for (const std::string& warning : LoadScenario(Scenario(name), settings).warnings) {
      text += (text.empty() ? "" : "\n") + warning;
    }
    return WithoutFolder(text);
  }
  std::string WithoutFolder(std::string text) const {
    const std::string prefix = root_.string() + "/";
    for (std::size_t at = 0; (at = text.find(prefix, at)) != std::string::npos;) text.erase(at, prefix.size());
    return text;
  }
  /// Replaces a text that occurs once in the file.
  void Edit(const std::string& name, const std::string& before, const std::string& after) const {
    std::ifstream in(root_ / name);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    ASSERT_NE(text.find(before), std::string::npos) << before;
    Put(name, text.replace(text.find(before), before.size(), after));
  }

  fs::path root_;
};

TEST_F(ScenarioRules, TheProjectsOwnScenariosKeepAllOfThem) {
  for (const auto& file : fs::directory_iterator(root_ / "scenarios")) {
    EXPECT_EQ(ErrorsOf(file.path().string()), "") << file.path();
    for (const std::string& warning : LoadScenario(file.path().string(), {}).warnings) {
      // Two truths about real trains that their users shall hear.
      const bool is_known = warning.find("starting_effort_n asks for 0.43331 of the weight") != std::string::npos ||
                            warning.find("applies the brake again after a release") != std::string::npos;
      EXPECT_TRUE(is_known) << file.path() << ": " << warning;
    }
  }
}

// ---- vehicles of which no wagon can be built

TEST_F(ScenarioRules, ContactsBeyondKalkersTableNameTheirLine) {
  Edit("vehicles/ore_wagon.yaml", "wheel_lateral_radius_m: -0.1952", "wheel_lateral_radius_m: -0.0801");
  const std::string complaint =
      "wheel_rail.hertz gives no contact with wheelset.wheel_radius_m 0.485: Kalker's table holds a/b in "
      "[0.1, 10], got ";
  // The curvatures nearly cancel, so that the ellipse is far longer across the rail than along it.
  EXPECT_EQ(ErrorsOf(Scenario("dip")).find("vehicles/ore_wagon.yaml:37: train.consist[0].vehicle." + complaint), 0u)
      << ErrorsOf(Scenario("dip"));
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"model=ltd"}), "") << "the LTD models have no contact";
  try {
    LoadVehicle((root_ / "vehicles/ore_wagon.yaml").string(), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(WithoutFolder(error.what()).find("vehicles/ore_wagon.yaml:37: " + complaint), 0u) << error.what();
  }
}

TEST_F(ScenarioRules, ContactsFromOverrides) {
  const std::string hertz = "train.consist[0].vehicle.wheel_rail.hertz.";
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {hertz + "wheel_lateral_radius_m=0"}),
            "--set " + hertz + "wheel_lateral_radius_m=0: " + hertz + "wheel_lateral_radius_m must not be 0, got 0");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {hertz + "wheel_lateral_radius_m=-0.07"}),
            "--set " + hertz + "wheel_lateral_radius_m=-0.07: " + hertz +
                "wheel_lateral_radius_m must make a point contact: a concave wheel needs a radius larger than "
                "rail_lateral_radius_m (0.08), got -0.07");
  const std::string wheel_radius = "train.consist[0].vehicle.wheelset.wheel_radius_m=2";
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{hertz + "rail_lateral_radius_m=0.01"},
        std::vector<std::string>{wheel_radius, hertz + "rail_lateral_radius_m=0.03"}}) {
    const std::string errors = ErrorsOf(Scenario("dip"), settings);
    EXPECT_NE(errors.find("train.consist[0].vehicle.wheel_rail.hertz gives no contact with wheelset.wheel_radius_m"),
              std::string::npos)
        << errors;
  }
}

TEST_F(ScenarioRules, MassesThatNoWagonHas) {
  Edit("vehicles/ore_wagon.yaml", "mass_kg: 147599.8", "mass_kg: 1e40");
  EXPECT_EQ(ErrorsOf(Scenario("dip")),
            "vehicles/ore_wagon.yaml:12: train.consist[0].vehicle.carbody.mass_kg must be at most 1000000 kg in "
            "size: no train has more; is it in kg?, got 1e40");
}

// ---- the step

TEST_F(ScenarioRules, StepsBeyondTheLargestStableOne) {
  const Settings two_ms = {"dt_s=0.002", "exchange_interval_s=0.002", "record_interval_s=0.002"};
  EXPECT_EQ(ErrorsOf(Scenario("dip"), two_ms),
            "--set dt_s=0.002: dt_s must be at most 0.00174, the largest stable step of vehicle ore_wagon "
            "(train_sim modes), got 0.002");
  Settings ltd = two_ms;
  ltd.push_back("model=ltd");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), ltd), "");
  // Stiffer by 4 and therefore faster by 2, of one type among others: the default step is refused too.
  Put("vehicles/stiff.yaml",
      "base: ore_wagon\nname: stiff\nadaptor_pad: {stiffness_n_per_m: 1.2e8}\nwheel_rail: {normal: "
      "{stiffness_n_per_m: 2.4e9}}\nbolster_guide: {stiffness_n_per_m: 1.6e9}\ncentre_plate: "
      "{stiffness_n_per_m: 1.6e9}\n");
  const std::string file = Put("scenarios/stiff.yaml",
                               "base: dip\ntrain:\n  base: single_wagon\n  consist:\n  - {vehicle: ore_wagon}\n  - "
                               "{vehicle: stiff}\ntrack: level\n");
  const std::string errors = ErrorsOf(file);
  EXPECT_NE(errors.find("dt_s must be at most 0.000"), std::string::npos) << errors;
  EXPECT_NE(errors.find("of vehicle stiff (train_sim modes), got 0.001 (default)"), std::string::npos) << errors;
}

// ---- rules between keys

TEST_F(ScenarioRules, IntervalsShowBothNumbers) {
  EXPECT_EQ(ErrorsOf(Scenario("emergency"), {"exchange_interval_s=0.0015"}),
            "--set exchange_interval_s=0.0015: exchange_interval_s must be a multiple of dt_s (0.001), got 0.0015\n"
            "scenarios/emergency.yaml:16: record_interval_s must be a multiple of exchange_interval_s (0.0015), "
            "got "
            "0.01");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"dt_s=0.0007"}),
            "scenarios/dip.yaml:1: exchange_interval_s must be a multiple of dt_s (0.0007), got 0.001 (default)");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"record_interval_s=0.0105"}),
            "--set record_interval_s=0.0105: record_interval_s must be a multiple of exchange_interval_s (0.001, "
            "default), got 0.0105\nscenarios/dip.yaml:1: ledger_interval_s must be a multiple of record_interval_s "
            "(0.0105), got 1 (default)\nscenarios/dip.yaml:9: duration_s must be a multiple of record_interval_s "
            "(0.0105), got 6");
}

TEST_F(ScenarioRules, CommandsAndSourcesNameTheirIndex) {
  const std::string file = Put("scenarios/a.yaml",
                               "base: emergency\ncommands:\n  - {time_s: 1, kind: emergency}\n"
                               "  - {time_s: 2, kind: apply, reduction_kpa: 20}\ndetail_vehicles: [1, 243]\n");
  EXPECT_EQ(ErrorsOf(file),
            "scenarios/a.yaml:4: commands[1].reduction_kpa must be in [50, 170] (brake.service.reduction_kpa), got "
            "20\n"
            "scenarios/a.yaml:5: detail_vehicles[1] must be in [1, 242], or in [-242, -1] from the rear, because "
            "the "
            "train has 242 vehicles, got 243");
  EXPECT_EQ(ErrorsOf(Scenario("emergency"), {"brake.sources[1].vehicle=300"}),
            "--set brake.sources[1].vehicle=300: brake.sources[1].vehicle must be in [1, 242], or in [-242, "
            "-1] from "
            "the rear, because the train has 242 vehicles (mid-train locomotive), got 300");
  EXPECT_EQ(ErrorsOf(Scenario("minimum"), {"commands[1].time_s=1.5"}),
            "--set commands[1].time_s=1.5: commands[1].time_s must be at least that of the command before, 2 "
            "s, got "
            "1.5");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"detail_vehicles[0]=2"}),
            "--set detail_vehicles[0]=2: detail_vehicles[0] must be 1 or -1, because the train has 1 "
            "vehicle, got 2");
}

TEST_F(ScenarioRules, BrakesThatDoNotSuitTheTrain) {
  Put("brakes/vent_only.yaml", "base: calibrated\nsources: [{vehicle: 1, releases: false}]\n");
  const std::string file = Put("scenarios/a.yaml", "base: minimum\nbrake: vent_only\n");
  EXPECT_EQ(ErrorsOf(file),
            "brakes/vent_only.yaml:2: brake.sources must list a source that releases the brakes, as "
            "commands[1] demands");
  Put("brakes/weak.yaml", "base: vent_only\nemergency: {rise_rate_per_s: 0.1}\n");
  Put("scenarios/b.yaml", "base: emergency\nbrake: weak\n");
  EXPECT_EQ(ErrorsOf(Scenario("b")),
            "brakes/calibrated.yaml:23: brake.emergency.rise_rate_fall_per_s must be below rise_rate_per_s "
            "(0.1), got "
            "0.1683");
}

TEST_F(ScenarioRules, DipsUnderTheStandingTrain) {
  const std::string file = Put("scenarios/a.yaml",
                               "base: emergency\ntrack:\n  base: level\n  dips:\n"
                               "  - {from_m: 10, depth_m: 0.05, length_m: 10}\n"
                               "  - {from_m: -20, depth_m: 0.05, length_m: 10}\n");
  EXPECT_EQ(ErrorsOf(file),
            "scenarios/a.yaml:6: track.dips[1] must not lie under the train at its start, which stands on "
            "[-2535.8, "
            "5.25] m; the dip is on [-20, -10] m");
  EXPECT_EQ(ErrorsOf(file, {"model=ltd"}), "");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"start_position_m=34"}),
            "");  // the front at 39.25 m, the dip from 40 m
  EXPECT_NE(ErrorsOf(Scenario("dip"), {"start_position_m=35"}), "");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"start_position_m=56"}), "");  // the rear at 50.75 m, the dip to 50 m
}

TEST_F(ScenarioRules, HugeCountsAreRefusedBeforeAnythingIsMadeOfThem) {
  const std::string count = "train.consist[0].count";
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {count + "=1e9"}),
            "--set " + count + "=1e9: " + count + " must be in [1, 100000], got 1e9");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {count + "=1e99"}),
            "--set " + count + "=1e99: " + count + " must be in [1, 100000], got 1e99");
  EXPECT_EQ(ErrorsOf(Scenario("emergency"), {"model=ltd", "detail_vehicles=[]", "train.consist[1].count=99900"}),
            "trains/paper_242.yaml:9: train.consist[3].count makes the train too long: it must have at most 100000 "
            "vehicles "
            "in all, got 120");

  std::string flood = "base: full_service\ncommands:\n";
  for (int i = 0; i < 15000; ++i) flood += "- {time_s: 1, kind: apply, reduction_kpa: 100}\n";
  EXPECT_EQ(ErrorsOf(Put("scenarios/flood.yaml", flood)),
            "scenarios/flood.yaml:3: commands must list at most 13774 commands for 242 vehicles and 3 brake "
            "sources");
  std::string sources = "base: dip\nbrake:\n  base: single_vehicle\n  sources:\n";
  for (int i = 0; i < 101; ++i) sources += "  - {vehicle: 1}\n";
  EXPECT_EQ(ErrorsOf(Put("scenarios/sources.yaml", sources)),
            "scenarios/sources.yaml:5: brake.sources must list at most 100 sources");
}

TEST_F(ScenarioRules, FilesThatAreSomethingElse) {
  fs::copy_file(root_ / "vehicles/ore_wagon.yaml", root_ / "trains/swapped.yaml");
  const std::string swapped = ErrorsOf(Scenario("dip"), {"train=swapped"});
  EXPECT_EQ(swapped.find("trains/swapped.yaml:"), 0u) << swapped;
  EXPECT_NE(swapped.find("train.length_m is not a known key; known keys: name, connection, consist"), std::string::npos)
      << swapped;
  const std::string table = Put("t.csv", "time_s,vehicle_1_pa\n0,0\n");
  EXPECT_EQ(ErrorsOf(table), "t.csv:1: must hold a map of keys and values, got 'time_s,vehicle_1_pa 0,0'");
  EXPECT_EQ(ErrorsOf(Scenario("single_wagon_stop"), {"pressure_table=" + Scenario("dip")}).find("scenarios/dip.yaml:"),
            0u);
  const std::string truncated = Put("scenarios/cut.yaml", "base: dip\ntrack: {name: x, grades: [{from_m: 0, gra");
  EXPECT_EQ(ErrorsOf(truncated).find("scenarios/cut.yaml:2: "), 0u) << ErrorsOf(truncated);
}

TEST_F(ScenarioRules, HostileTracks) {
  const std::string file = Put("scenarios/a.yaml",
                               "base: dip\ntrack:\n  name: t\n  grades:\n"
                               "  - {from_m: nan, grade_percent: steep}\n"
                               "  - {from_m: 1e400, grade_percent: -1e9}\n"
                               "  dips:\n  - {from_m: 40, depth_m: -1, length_m: 0}\n");
  EXPECT_EQ(ErrorsOf(file),
            "scenarios/a.yaml:5: track.grades[0].from_m must be a finite number, got 'nan'\n"
            "scenarios/a.yaml:5: track.grades[0].grade_percent must be a number, got 'steep'\n"
            "scenarios/a.yaml:6: track.grades[1].from_m must be a number within the range of double precision, got "
            "'1e400'\n"
            "scenarios/a.yaml:6: track.grades[1].grade_percent must be in [-20, 20], got -1e9\n"
            "scenarios/a.yaml:8: track.dips[0].length_m must be > 0, got 0");
}

TEST_F(ScenarioRules, UnitsOfNoVehicles) {
  const std::string unit = "train.consist[0].vehicles_per_unit";
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {unit + "=0"}),
            "--set " + unit + "=0: " + unit + " must be in [1, 100000], got 0");
  TrainParams train = LoadScenario(Scenario("dip"), {}).params.train;
  train.consist[0].vehicles_per_unit = 0;
  EXPECT_THROW(Validate(train), std::invalid_argument);
}

TEST_F(ScenarioRules, AControllerSamplesEveryWholeNumberOfSteps) {
  const Settings with = {"train.consist[0].vehicle.wheel_slide_protection=threshold_3state",
                         "train.consist[0].vehicle.wheel_slide_protection.sampling_period_s=0.0205",
                         "train.consist[0].vehicle.wheel_slide_protection.valve.delay_s=0.0301"};
  const std::string errors = ErrorsOf(Scenario("single_wagon_stop"), with);
  EXPECT_NE(errors.find("sampling_period_s must be a multiple of dt_s (0.001, default), got 0.0205"), std::string::npos)
      << errors;
  EXPECT_NE(errors.find("valve.delay_s must be a multiple of dt_s (0.001, default), got 0.0301"), std::string::npos)
      << errors;
}

TEST_F(ScenarioRules, AControllerMustBeOneThatExists) {
  const std::string errors =
      ErrorsOf(Scenario("single_wagon_stop"), {"train.consist[0].vehicle.wheel_slide_protection=creep_control",
                                               "train.consist[0].vehicle.wheel_slide_protection.controller=threshold"});
  EXPECT_NE(errors.find("controller must be one of threshold_3state, creep_control, got 'threshold'"),
            std::string::npos)
      << errors;
}

TEST_F(ScenarioRules, TheLtdModelLeavesOutWheelSlideProtection) {
  EXPECT_NE(
      WarningsOf("single_wagon_stop", {"model=ltd", "train.consist[0].vehicle.wheel_slide_protection=threshold_3state"})
          .find("the ltd model leaves out train.consist[0].vehicle.wheel_slide_protection"),
      std::string::npos);
}

TEST_F(ScenarioRules, AreJudgedBesideErrorsInKeysThatTheyDoNotRead) {
  const std::string file = Put("scenarios/a.yaml", "base: dip\ninitial_speed_kmh: fast\ndt_s: 0.0007\n");
  EXPECT_EQ(ErrorsOf(file),
            "scenarios/a.yaml:1: exchange_interval_s must be a multiple of dt_s (0.0007), got 0.001 (default)\n"
            "scenarios/a.yaml:2: initial_speed_kmh must be a number, got 'fast'");
}

TEST_F(ScenarioRules, WhatReadsTheTrainIsJudgedBesideErrorsOfTheTrain) {
  const std::string errors = ErrorsOf(Put("scenarios/a.yaml",
                                          "base: single_wagon_stop\n"
                                          "train:\n"
                                          "  name: t\n"
                                          "  connection: friction_gear\n"
                                          "  consist:\n"
                                          "  - {vehicle: {base: ore_wagon, kolour: red}, count: 3}\n"
                                          "  - {vehicle: ore_wagon, count: 2, initial_throttle_notch: 3}\n"
                                          "detail_vehicles: [6]\n"
                                          "brake:\n"
                                          "  base: single_vehicle\n"
                                          "  sources: [{vehicle: 9, application_delay_s: -1}]\n"
                                          "commands:\n"
                                          "- {time_s: 2, kind: apply, reduction_kpa: 1000}\n"
                                          "- {time_s: 1, kind: emergency, colour: red}\n"
                                          "- {time_s: 3, kind: throttle, notch: 2}\n"));
  for (const char* error :
       {"6: train.consist[0].vehicle.kolour is not a known key",
        "7: train.consist[1].initial_throttle_notch must be at most 0", "8: detail_vehicles[0] must be in",
        "11: brake.sources[0].vehicle must be in", "11: brake.sources[0].application_delay_s must be",
        "13: commands[0].reduction_kpa must be in", "14: commands[1].time_s must be at least",
        "14: commands[1].colour is not a known key", "15: commands[2].kind must not be throttle"}) {
    EXPECT_NE(errors.find("scenarios/a.yaml:" + std::string(error)), std::string::npos) << error << "\n" << errors;
  }
}

TEST_F(ScenarioRules, TracksAreJudgedBesideErrorsOfOtherEntries) {
  const std::string errors = ErrorsOf(Put("scenarios/a.yaml",
                                          "base: single_wagon_stop\n"
                                          "track:\n"
                                          "  name: t\n"
                                          "  grades:\n"
                                          "  - {from_m: 100, grade_permille: 2}\n"
                                          "  - {from_m: 50, grade_permille: x}\n"
                                          "  friction_patches:\n"
                                          "  - {from_m: 10, to_m: 20, adhesion: low}\n"
                                          "  - {from_m: 20.5, to_m: 30, adhesion: {base: wet, slip_reduction: 2}}\n"
                                          "  curves:\n"
                                          "  - {from_m: 0, to_m: 100, radius_m: 300}\n"
                                          "  - {from_m: 90, to_m: 200, radius_m: 3}\n"));
  for (const char* error : {"6: track.grades[1].from_m must be greater than", "6: track.grades[1].grade",
                            "track.friction_patches[1].ramp_length_m must leave room",
                            "9: track.friction_patches[1].adhesion.slip_reduction",
                            "12: track.curves[1].from_m must be at least to_m", "12: track.curves[1].radius_m"})
    EXPECT_NE(errors.find(error), std::string::npos) << error << "\n" << errors;
}

TEST_F(ScenarioRules, TrappedAirNeedsABrakeThatActs) {
  Put("p.csv", "time_s,p_kpa[1]\n0,0\n10,100\n");
  const std::string trapped = "train.consist[0].trapped_cylinder_pressure_kpa=200";
  EXPECT_EQ(ErrorsOf(Scenario("single_wagon_stop"), {trapped}), "");
  EXPECT_EQ(ErrorsOf(Scenario("single_wagon_stop"), {trapped, "pressure_table=../p.csv"}),
            "--set " + trapped +
                ": train.consist[0].trapped_cylinder_pressure_kpa needs brake: a pressure_table has the "
                "pressures of all vehicles, got 200");
  EXPECT_EQ(ErrorsOf(Scenario("single_wagon_stop"), {trapped, "train.consist[0].vehicle.brake_rigging.cut_out=true"}),
            "--set " + trapped +
                ": train.consist[0].trapped_cylinder_pressure_kpa has no effect in a vehicle with "
                "brake_rigging.cut_out, got 200");
}

// ---- pressure tables

TEST_F(ScenarioRules, PressureTablesCountFromWhereTheyAreNamed) {
  Put("tables/t.csv", "time_s,vehicle_1_pa\n0,0\n1,1000\n");
  Put("shared/base.yaml", "base: ../scenarios/dip.yaml\npressure_table: ../tables/t.csv\n");
  const std::string file = Put("elsewhere/deep/a.yaml", "base: ../../shared/base.yaml\n");
  const LoadedScenario loaded = LoadScenario(file, {});
  EXPECT_EQ(loaded.params.pressure_table, (root_ / "tables/t.csv").string());
  std::vector<double> pressure_pa;
  BrakeSystem(loaded.pressures).PressuresAt(0.5, pressure_pa);
  EXPECT_NEAR(pressure_pa.at(0), 500.0, 1e-9);  // midway; the rounding of one interpolation

  const fs::path here = fs::current_path();
  fs::current_path(root_ / "tables");
  const LoadedScenario overridden = LoadScenario(Scenario("dip"), {"pressure_table=t.csv"});
  fs::current_path(here);
  EXPECT_EQ(overridden.params.pressure_table, (root_ / "tables/t.csv").string());
}

// ---- warnings

TEST_F(ScenarioRules, WarnsOfExchangeIntervalsThatTheConnectionsDoNotStand) {
  EXPECT_EQ(WarningsOf("emergency", {"exchange_interval_s=0.01"}),
            "--set exchange_interval_s=0.01: exchange_interval_s 0.01 is above 0.0066083, the longest stable "
            "one of train.connection at 900 kN: coupler forces may diverge; take a shorter one");
  EXPECT_EQ(WarningsOf("emergency", {"exchange_interval_s=0.005"}), "");
  EXPECT_EQ(WarningsOf("dip", {"exchange_interval_s=0.01", "record_interval_s=0.01"}), "")
      << "one wagon has no connection";
  EXPECT_EQ(WarningsOf("emergency", {"model=ltd", "exchange_interval_s=0.005"}), "");
  EXPECT_NE(WarningsOf("emergency", {"model=ltd", "exchange_interval_s=0.01"}), "");
  // While it sticks at 1e9 N/m, a head of 127.4 t stands sqrt(m / k) = 11.3 ms.
  const Settings sticks = {"train.connection.draft_gear.friction=stick_spring", "record_interval_s=0.02"};
  const auto with = [&](const char* interval) {
    Settings settings = sticks;
    settings.emplace_back(interval);
    return WarningsOf("emergency", settings);
  };
  EXPECT_EQ(with("exchange_interval_s=0.01"), "");
  EXPECT_NE(with("exchange_interval_s=0.02").find("above 0.011286, the longest stable one of train.connection: "),
            std::string::npos);
}

TEST_F(ScenarioRules, WarningsNameTheLineOfWhatIsWritten) {
  const std::string file = Put("scenarios/a.yaml", "base: emergency\ndescription: x\nexchange_interval_s: 0.01\n");
  EXPECT_EQ(WithoutFolder(LoadScenario(file, {}).warnings.at(0)).find("scenarios/a.yaml:3: exchange_interval_s 0.01"),
            0u);
}

TEST_F(ScenarioRules, WarnsOfFrictionTooSteepForTheStep) {
  // 2 * 900 kN * 0.33 * 1 ms / (tan(22 deg) * 160113.8 kg) = 9.182 mm/s.
  const std::string speed = "train.connection.draft_gear.smoothing_speed_mps";
  EXPECT_EQ(WarningsOf("emergency", {speed + "=0.009"}),
            "--set " + speed + "=0.009: " + speed +
                " 0.009 is below 0.0091822, the least for dt_s 0.001 at 900 kN and 1.6011e+05 kg: the "
                "friction of the "
                "draft gears may chatter; take a smaller dt_s");
}

TEST_F(ScenarioRules, WarnsOfAWheelsetThatCannotExist) {
  // m r^2 = 1731.8 kg (0.485 m)^2 = 407.36 kg m2.
  const std::string inertia = "train.consist[0].vehicle.wheelset.pitch_inertia_kgm2";
  const std::string again = "train.consist[0].vehicle.wheelset.accept_large_inertia=false";
  EXPECT_EQ(WarningsOf("single_wagon_stop", {again}),
            "vehicles/ore_wagon.yaml:25: " + inertia +
                " is 1.6668 times mass_kg wheel_radius_m^2, more than if all mass were at the tread (a real "
                "freight wheelset has 100 to 130 kg m2): its wheels lock later, slide less far and turn again "
                "sooner than real ones; if that is meant, say accept_large_inertia: true");
  EXPECT_EQ(WarningsOf("single_wagon_stop", {again, inertia + "=407.3"}), "");
  EXPECT_NE(WarningsOf("single_wagon_stop", {again, inertia + "=407.4"}), "");
  EXPECT_EQ(WarningsOf("single_wagon_stop"), "");  // the paper's wagon says so itself
  for (const char* wagon : {"ore_wagon_loaded", "ore_wagon_empty"}) {
    Put("scenarios/a.yaml", std::string("base: single_wagon_stop\ntrain:\n  name: one\n  connection: "
                                        "calibrated\n  consist: [{vehicle: ") +
                                wagon + ", count: 1}]\n");
    EXPECT_EQ(WarningsOf("a"), "") << wagon;
  }
}

TEST_F(ScenarioRules, AnUnknownReactionIsRefused) {
  Edit("vehicles/ore_wagon_loaded.yaml", "reaction: frame", "reaction: bogie");
  Edit("vehicles/ore_wagon_loaded.yaml", "friction_speed: tread", "friction_speed: wheel");
  Put("scenarios/a.yaml",
      "base: single_wagon_stop\ntrain: {name: one, connection: calibrated, consist: [{vehicle: "
      "ore_wagon_loaded, count: 1}]}\n");
  const std::string errors = ErrorsOf(Scenario("a"));
  EXPECT_NE(errors.find("vehicles/ore_wagon_loaded.yaml:11: "), std::string::npos) << errors;
  EXPECT_NE(errors.find("brake_rigging.reaction must be one of frame, carbody, none, got 'bogie'"), std::string::npos)
      << errors;
  EXPECT_NE(errors.find("brake_rigging.friction_speed must be one of tread, vehicle, got 'wheel'"), std::string::npos)
      << errors;
}

TEST_F(ScenarioRules, WarnsOfCommandsWithoutEffectWhereTheyAreWritten) {
  Put("scenarios/a.yaml",
      "base: single_wagon_stop\ncommands:\n- {time_s: 2, kind: emergency}\n- {time_s: 7, kind: release}\n");
  EXPECT_EQ(WarningsOf("a"),
            "scenarios/a.yaml:4: commands[1] has no effect: the emergency of commands[0] holds until a "
            "release at 62 s "
            "or later (brake.emergency.blocking_time_s)");
  Put("scenarios/b.yaml",
      "base: single_wagon_stop\ncommands:\n- {time_s: 2, kind: apply, reduction_kpa: 90}\n- {time_s: 7, "
      "kind: release}\n"
      "- {time_s: 11, kind: apply, reduction_kpa: 60}\n");
  EXPECT_EQ(WarningsOf("b").find("scenarios/b.yaml:5: commands[2] applies the brake again after a release"), 0u)
      << WarningsOf("b");
}

TEST_F(ScenarioRules, ASmallerReductionNeedsASourceThatReleases) {
  Put("scenarios/a.yaml",
      "base: single_wagon_stop\nbrake: {base: single_vehicle, sources: [{vehicle: 1, releases: "
      "false}]}\ncommands:\n"
      "- {time_s: 2, kind: apply, reduction_kpa: 90}\n- {time_s: 7, kind: apply, reduction_kpa: 60}\n");
  try {
    LoadScenario(Put("scenarios/c.yaml", "base: a\n"), {});
    ADD_FAILURE() << "was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("brake.sources must list a source that releases the brakes, as commands[1] demands"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(ScenarioRules, BadGearTablesAreToldAllAtOnceWithTheirLines) {
  Put("couplers/bad.yaml",
      "name: bad\nkind: table\ntable:\n  slack_m: 0.01\n  locked_stiffness_n_per_m: 1.0e6\n  loading:\n"
      "    travel_m: [0, 0.01, 0.05]\n    force_n: [5000, 100000, 60000]\n  unloading:\n    travel_m: [0]\n  "
      "  force_n: [0]\n"
      "  compression:\n    loading:\n      travel_m: [0, 0.1]\n      force_n: [0, 50000]\n"
      "    unloading:\n      travel_m: [0, 0.1]\n      force_n: [0, 60000]\n");
  const std::string file = Put("scenarios/a.yaml", "base: emergency\ntrain: {base: paper_242, connection: bad}\n");
  const std::string errors = ErrorsOf(file);
  for (const char* error :
       {"couplers/bad.yaml:8: train.connection.table.loading.force_n must start at 0: at the end of the "
        "slack there is no "
        "force",
        "couplers/bad.yaml:8: train.connection.table.loading.force_n must not descend",
        "couplers/bad.yaml:10: train.connection.table.unloading.travel_m must list 2 to 32 points",
        "couplers/bad.yaml:18: train.connection.table.compression.unloading.force_n must nowhere be above"}) {
    EXPECT_NE(errors.find(error), std::string::npos) << error << "\nin\n" << errors;
  }
  // Two rules of the whole, once the curves are right.
  Put("couplers/soft.yaml", "base: ge_standard_pair\ntable:\n  locked_stiffness_n_per_m: 1.0e7\n");
  EXPECT_EQ(ErrorsOf(Put("scenarios/b.yaml", "base: emergency\ntrain: {base: paper_242, connection: soft}\n"))
                .find("couplers/soft.yaml:3: train.connection.table.locked_stiffness_n_per_m must exceed the "
                      "steepest slope"),
            0u);
}

TEST_F(ScenarioRules, WarnsOfWhatIsNotUsed) {
  Put("t.csv", "time_s,vehicle_1_pa\n0,0\n90,1000\n");
  const std::string table = "pressure_table=" + (root_ / "t.csv").string();
  EXPECT_EQ(WarningsOf("dip", {"model=ltd"}), "tracks/dip.yaml:4: the ltd model leaves out track.dips (1 entry)");
  EXPECT_EQ(WarningsOf("single_wagon_stop", {table}),
            "scenarios/single_wagon_stop.yaml:7: brake is not used: the pressures come from pressure_table\n"
            "scenarios/single_wagon_stop.yaml:9: commands of the brake (1 entry) are not used: the pressures "
            "come from "
            "pressure_table");
  Put("scenarios/a.yaml",
      "base: single_wagon_stop\nmodel: ltd-no-inertia\ntrack:\n  base: level\n"
      "  friction_patches:\n  - {from_m: 1, to_m: 2, friction_coefficient: 0.1}\n"
      "  - {from_m: 3, to_m: 4, friction_coefficient: 0.1}\nadhesion_limit: false\n");
  EXPECT_EQ(WarningsOf("a"),
            "scenarios/a.yaml:6: the ltd-no-inertia model leaves out track.friction_patches (2 entries)");
}

TEST_F(ScenarioRules, ListsOutOfOrderNameTheirEntries) {
  const std::string track = Put("scenarios/a.yaml",
                                "base: dip\ntrack:\n  name: t\n  grades:\n  - {from_m: 0, grade_percent: 1}\n"
                                "  - {from_m: 90, grade_percent: 0}\n  - {from_m: 80, grade_percent: 1}\n"
                                "  - {from_m: 85, grade_percent: 2}\n  - {from_m: 85, grade_percent: 3}\n");
  EXPECT_EQ(ErrorsOf(track),
            "scenarios/a.yaml:7: track.grades[2].from_m must be greater than that of the entry before, 90, got 80\n"
            "scenarios/a.yaml:9: track.grades[4].from_m must be greater than that of the entry before, 85, got 85");
  EXPECT_EQ(ErrorsOf(Scenario("dip"), {"brake.service.reduction_kpa[2]=60"}),
            "--set brake.service.reduction_kpa[2]=60: brake.service.reduction_kpa[2] must be greater than the one "
            "before, 70, got 60");
}

TEST_F(ScenarioRules, RampsOfPatchesNameTheirEntries) {
  const std::string file = Put("scenarios/a.yaml",
                               "base: dip\ntrack:\n  name: t\n  friction_patches:\n"
                               "  - {from_m: 10, to_m: 20, adhesion: low}\n"
                               "  - {from_m: 20.5, to_m: 30, adhesion: {base: wet, slip_reduction: 0.2}, "
                               "ramp_length_m: 2}\n"
                               "  - {from_m: 60, to_m: 70, adhesion: low, friction_coefficient: 0.1}\n");
  const std::string ramps =
      "scenarios/a.yaml:6: track.friction_patches[1].ramp_length_m must leave room to the next change of the "
      "surface: half of a ramp lies on each side of an end, and the ones at 20 m (1 m long) and 20.5 m (2 m) "
      "overlap, got 2";
  EXPECT_EQ(ErrorsOf(file), ramps +
                                "\nscenarios/a.yaml:7: track.friction_patches[2].friction_coefficient must not "
                                "stand beside adhesion, which has one, got 0.1");
  EXPECT_EQ(ErrorsOf(file, {"track.friction_patches[2]={from_m: 60, to_m: 70, friction_coefficient: 0.1}"}), ramps);
}

TEST_F(ScenarioRules, ControllersGearTablesAndRampsAreToldAllAtOnce) {
  const std::string file = Put("scenarios/wrong_in_all.yaml",
                               "name: wrong_in_all\n"
                               "model: 2d\n"
                               "train:\n"
                               "  connection:\n"
                               "    kind: table\n"
                               "    table:\n"
                               "      locked_stiffness_n_per_m: 2.5e8\n"
                               "      locked_damping_ns_per_m: 1.3e6\n"
                               "      solid_stiffness_n_per_m: 2.5e8\n"
                               "      loading: {travel_m: [0, 0.02, 0.04], force_n: [0, 3.0e5, 6.0e5]}\n"
                               "      unloading: {travel_m: [0, 0.02, 0.04], force_n: [0, 1.0e5, 7.0e5]}\n"
                               "  consist:\n"
                               "    - vehicle:\n"
                               "        base: ore_wagon_empty\n"
                               "        wheel_slide_protection: {controller: threshold_3stat}\n"
                               "    - vehicle:\n"
                               "        base: ore_wagon_empty\n"
                               "        wheel_slide_protection: {base: threshold_3state, sampling_period_s: 0.0205}\n"
                               "      count: 2\n"
                               "      vehicles_per_unit: 2\n"
                               "      unit_connection:\n"
                               "        kind: table\n"
                               "        table:\n"
                               "          locked_stiffness_n_per_m: 2.5e8\n"
                               "          locked_damping_ns_per_m: 1.3e6\n"
                               "          solid_stiffness_n_per_m: 2.5e8\n"
                               "          loading: {travel_m: [0, 0.02, 0.04], force_n: [0, 3.0e5, 2.0e5]}\n"
                               "          unloading: {travel_m: [0, 0.02, 0.04], force_n: [0, 1.0e5, 1.0e5]}\n"
                               "track:\n"
                               "  friction_patches:\n"
                               "    - {from_m: 0, to_m: 100, adhesion: low, ramp_length_m: 20}\n"
                               "    - {from_m: 110, to_m: 300, adhesion: wet, ramp_length_m: 20}\n"
                               "brake: single_vehicle\n"
                               "commands: [{time_s: 2, kind: emergency}]\n"
                               "initial_speed_kmh: 80\n"
                               "duration_s: 10\n");
  const std::string errors = ErrorsOf(file);
  const auto tells = [&](const std::string& error) {
    return errors.find("scenarios/wrong_in_all.yaml:" + error) != std::string::npos;
  };
  EXPECT_TRUE(
      tells("11: train.connection.table.unloading.force_n must nowhere be above loading.force_n: "
            "where the curves cross the device would give energy"))
      << errors;
  EXPECT_TRUE(
      tells("15: train.consist[0].vehicle.wheel_slide_protection.controller must be one of "
            "threshold_3state, creep_control, got 'threshold_3stat'"))
      << errors;
  EXPECT_TRUE(tells("27: train.consist[1].unit_connection.table.loading.force_n must not descend")) << errors;
  EXPECT_TRUE(
      tells("32: track.friction_patches[1].ramp_length_m must leave room to the next change of the "
            "surface"))
      << errors;
  EXPECT_TRUE(
      tells("18: train.consist[1].vehicle.wheel_slide_protection.sampling_period_s must be a multiple of "
            "dt_s (0.001, default), got 0.0205"))
      << errors;
  EXPECT_EQ(4, std::count(errors.begin(), errors.end(), '\n')) << "five errors, and no other:\n" << errors;
}

TEST_F(ScenarioRules, WarnsOfPatchesAndDipsOutOfReach) {
  // The front of the wagon starts at 5.25 m and is at most 100 m further after 6 s of 60 km/h; its rear at -5.25 m.
  Put("scenarios/a.yaml",
      "base: dip\ntrack:\n  base: dip\n  friction_patches:\n"
      "  - {from_m: 105, to_m: 200, friction_coefficient: 0.1}\n"
      "  - {from_m: 106, to_m: 200, friction_coefficient: 0.1}\n"
      "  - {from_m: -30, to_m: -6, friction_coefficient: 0.1}\n");
  EXPECT_EQ(WarningsOf("a"),
            "scenarios/a.yaml:6: track.friction_patches[1] on [106, 200] m is reached by no wheel: they are "
            "on [-5.25, "
            "105.25] m at most in this run (2 entries of track.friction_patches are not)");
  // Downhill it comes further: 9.81 m/s2 x 2 % x (6 s)^2 / 2 = 3.5 m.
  EXPECT_EQ(WarningsOf("a", {"track.grades=[{from_m: 0, grade_percent: -2}]", "track.friction_patches[2].to_m=0"}), "");
  EXPECT_EQ(WarningsOf("dip", {"duration_s=2"}),
            "tracks/dip.yaml:4: track.dips[0] on [40, 50] m is reached by no wheel: they are on [-5.25, "
            "38.583] m at "
            "most in this run");
}

// ---- models of single groups -----------------------------------------------------------------------------------

TEST_F(ScenarioRules, AGroupHasItsOwnModelOrTheScenarios) {
  const ScenarioParams mixed =
      config::LoadScenario(Scenario("emergency"), {"model=ltd-no-inertia", "train.consist[0].model=2d",
                                                   "train.consist[2].model=ltd", "detail_vehicles=[1, 2]"})
          .params;
  const std::vector<VehicleModel> models = mixed.VehicleModels();
  ASSERT_EQ(models.size(), 242u);
  EXPECT_EQ(models[0], VehicleModel::kTwoD);
  EXPECT_EQ(models[120], VehicleModel::kLtdNoInertia);
  EXPECT_EQ(models[121], VehicleModel::kLtd);
  EXPECT_EQ(models[241], VehicleModel::kLtdNoInertia);
  EXPECT_EQ(mixed.ModelNames(), "2d, ltd, ltd-no-inertia");
  EXPECT_EQ(mixed.DetailedVehicles(), std::vector<int>({0}));  // the other one has no details
  // Its text says the same.
  strict_config::ErrorList errors;
  const auto again = strict_config::LoadText<ScenarioParams>(strict_config::Write(mixed), "text", errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(again.VehicleModels(), models);
}

TEST_F(ScenarioRules, MixedModelsAreNamedInErrorsAndWarnings) {
  const std::string file = Scenario("emergency");
  EXPECT_NE(ErrorsOf(file, {"train.consist[1].model=ldt"})
                .find("train.consist[1].model must be one of 2d, ltd, ltd-no-inertia, got 'ldt'; did you mean ltd?"),
            std::string::npos);
  EXPECT_NE(ErrorsOf(file, {"model=ltd", "integrator=newmark", "train.consist[1].model=2d"})
                .find("must be leapfrog for the 2d model"),
            std::string::npos);
  EXPECT_NE(WarningsOf("emergency", {"train.consist[0].model=ltd", "detail_vehicles=[1]"})
                .find("detail_vehicles[0] is 1, a vehicle of the ltd model, which has no details"),
            std::string::npos);
}

TEST_F(ScenarioRules, ADipMayLieUnderVehiclesThatHaveNoContact) {
  // Vehicle 1 alone stands on [-5, 5] m or so; the dip lies under it.
  const std::string dip = "track.dips=[{from_m: -1, depth_m: 0.01, length_m: 2}]";
  EXPECT_NE(ErrorsOf(Scenario("emergency"), {dip}).find("must not lie under the train at its start"),
            std::string::npos);
  EXPECT_EQ(ErrorsOf(Scenario("emergency"), {dip, "train.consist[0].model=ltd"}), "");
  EXPECT_NE(ErrorsOf(Scenario("emergency"), {dip, "train.consist[1].model=ltd"})
                .find("must not lie under vehicles of the 2d model at their start"),
            std::string::npos);
}

}  // namespace
}  // namespace train_dynamics::config
