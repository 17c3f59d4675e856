#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "strict_config/csv_table.h"
#include "strict_config/error_list.h"
#include "strict_config/parameters.h"
#include "strict_config/reader.h"
#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "strict_config/validate.h"
#include "strict_config/writer.h"

namespace strict_config {
namespace {

namespace fs = std::filesystem;

// A small train in the vocabulary of parameters.h, with every verb in it.

enum class CouplerKind { kDraftGear, kDrawBar };

struct Coupler {
  CouplerKind kind = CouplerKind::kDraftGear;
  double slack_m = kRequired;
  double preload_n = 0.0;
  std::vector<double> stiffness_n_per_m;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("kind", kind, {{"draft_gear", CouplerKind::kDraftGear}, {"draw_bar", CouplerKind::kDrawBar}},
             "of the test");
    v.Number("slack_m", slack_m, kNonNegative, "of the test");
    v.Number("preload_n", preload_n, kNonNegative, "of the test");
    v.Numbers("stiffness_n_per_m", stiffness_n_per_m, kPositive, "of the test");
    v.Check(slack_m < 1.0, "slack_m", "must be less than the length of a vehicle");
  }
};

struct Contact {
  double friction_coefficient = 0.3;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("friction_coefficient", friction_coefficient, kFraction, "of the test");
  }
};

struct Vehicle {
  std::string name;
  double mass_kg = kRequired;
  Contact contact;
  Coupler coupler;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "of the test");
    v.Number("mass_kg", mass_kg, kPositive, "of the test");
    v.Group("contact", contact, "of the test");
    v.Part("coupler", coupler, "couplers", "of the test");
  }
};

struct ConsistEntry {
  int count = 1;
  Vehicle vehicle;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Integer("count", count, Range{1.0, 1000.0, false, false}, "of the test");
    v.Part("vehicle", vehicle, "vehicles", "of the test");
  }
};

struct Command {
  double time_s = kRequired;
  double reduction_kpa = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("time_s", time_s, kNonNegative, "of the test");
    v.Number("reduction_kpa", reduction_kpa, kNonNegative, "of the test");
  }
};

struct Scenario {
  double initial_speed_kmh = 80.0;
  bool record = true;
  std::vector<int> detailed;
  std::vector<ConsistEntry> consist;
  std::vector<Command> commands;
  std::vector<Coupler> spare_couplers;
  std::optional<Contact> patch;
  std::optional<Coupler> tail;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("initial_speed_kmh", initial_speed_kmh, kNonNegative, "of the test");
    v.Flag("record", record, "of the test");
    v.Integers("detailed", detailed, kNonNegative, "of the test");
    v.List("consist", consist, "of the test");
    v.List("commands", commands, "of the test");
    v.Parts("spare_couplers", spare_couplers, "couplers", "of the test");
    v.Group("patch", patch, "of the test");
    v.Part("tail", tail, "couplers", "of the test");
  }
};

/// A parameter that has to be given, in an integer.
struct Stages {
  int stages = kRequiredInteger;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Integer("stages", stages, kPositive, "of the test");
  }
};

/// A struct that may hold itself, the only way in which parts can nest without end.
struct Assembly {
  double mass_kg = 0.0;
  std::vector<Assembly> parts;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("mass_kg", mass_kg, kNonNegative, "of the test");
    v.Parts("parts", parts, "assemblies", "of the test");
  }
};

/// Each test has a folder of its own; messages are compared without its path.
class ConfigTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "config_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root = fs::canonical(pattern);
  }
  void TearDown() override { fs::remove_all(root); }

  std::string Put(const std::string& name, const std::string& text) {
    const fs::path file = root / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
  }

  std::string WithoutFolder(std::string text) const {
    const std::string prefix = root.string() + "/";
    for (std::size_t at = 0; (at = text.find(prefix, at)) != std::string::npos;)
      text.erase(at, prefix.size());
    return text;
  }

  template <class Struct>
  Struct LoadFile(const std::string& name, LoadOptions options = {}) {
    found = ErrorList();
    return Load<Struct>((root / name).string(), options, found);
  }

  /// The errors of reading `text` as a struct.
  template <class Struct = Scenario>
  std::string ErrorsOf(const std::string& text, const std::vector<std::string>& overrides = {}) {
    Put("a.yaml", text);
    LoadOptions options;
    options.overrides = overrides;
    LoadFile<Struct>("a.yaml", options);
    return Errors();
  }

  /// As ErrorsOf, where there must be none.
  template <class Struct = Scenario>
  Struct Read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    Put("a.yaml", text);
    LoadOptions options;
    options.overrides = overrides;
    Struct value = LoadFile<Struct>("a.yaml", options);
    EXPECT_EQ(Errors(), "");
    return value;
  }

  std::string Errors() const { return WithoutFolder(found.Text()); }

  fs::path root;
  ErrorList found;
};

// ---------------------------------------------------------------- numbers

TEST(Number, AcceptsPlainDecimals) {
  const std::pair<const char*, double> numbers[] = {
      {"0", 0.0},   {"-3", -3.0}, {"+4", 4.0},       {"0.5", 0.5}, {".5", 0.5},
      {"2.", 2.0},  {"1e8", 1e8}, {"1e-3", 1e-3},    {"1E3", 1e3}, {"1.5e+6", 1.5e6},
      {"-0", -0.0}, {"0e0", 0.0}, {"5e-324", 5e-324}};
  for (const auto& [text, value] : numbers) {
    const std::optional<double> parsed = ParseNumber(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(*parsed, value) << text;
    EXPECT_EQ(std::signbit(*parsed), std::signbit(value)) << text;
  }
}

TEST(Number, RefusesEverythingElse) {
  for (const char* text : {"",     "+",   "-",     ".",        "e5",   "1e",    "1e+",   "--1", "+-1",
                           "1 ",   " 1",  "1.2.3", "0x10",     "010",  "00",    "1_000", "1,5", "nan",
                           ".nan", "inf", "-.inf", "Infinity", "true", "1e999", "1:30",  "1f"}) {
    EXPECT_FALSE(ParseNumber(text)) << text;
  }
}

TEST(Number, RuleSaysHowToRepair) {
  EXPECT_EQ(NumberRule("80 km/h", false, "initial_speed_kmh"),
            "must be a plain number in km/h (the unit is in the key)");
  EXPECT_EQ(NumberRule("30%", false, "ratio"), "must be a plain number, without a unit");
  EXPECT_EQ(NumberRule("80", true, "x_m"), "must be a number without quotes");
  EXPECT_EQ(NumberRule("0,5", false, "x_m"), "must be a plain number, with a point for decimals");
  EXPECT_EQ(NumberRule("1_000", false, "x_m"), "must be a plain number, without separators");
  EXPECT_EQ(NumberRule("010", false, "x_m"), "must be a plain decimal number, without leading zeros");
  EXPECT_EQ(NumberRule("0x10", false, "x_m"), "must be a plain decimal number");
  EXPECT_EQ(NumberRule("0o17", false, "x_m"), "must be a plain decimal number");
  EXPECT_EQ(NumberRule("-.INF", false, "x_m"), "must be a finite number");
  EXPECT_EQ(NumberRule("1e999", false, "x_m"), "must be a number within the range of double precision");
  EXPECT_EQ(NumberRule("fast", false, "x_m"), "must be a number");
  EXPECT_EQ(NumberRule("1.2.3", false, "x_m"), "must be a number");
  EXPECT_EQ(NumberRule("1 ", false, "x_m"), "must be a number");
}

TEST(Number, ShortestDecimalReadsBackToTheSameBits) {
  EXPECT_EQ(ShortestDecimal(0.1), "0.1");
  EXPECT_EQ(ShortestDecimal(100000.0), "100000");
  EXPECT_EQ(ShortestDecimal(80.0), "80");
  EXPECT_EQ(ShortestDecimal(-0.0), "-0");
  EXPECT_EQ(ShortestDecimal(0.1 + 0.2), "0.30000000000000004");
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::optional<double> back = ParseNumber(ShortestDecimal(value));
    ASSERT_TRUE(back) << ShortestDecimal(value);
    EXPECT_EQ(*back, value) << ShortestDecimal(value);
    EXPECT_EQ(std::signbit(*back), std::signbit(value)) << ShortestDecimal(value);
  }
}

TEST(Ranges, RulesInWords) {
  EXPECT_EQ(kFinite.Rule(), "must be a finite number");
  EXPECT_EQ(kPositive.Rule(), "must be > 0");
  EXPECT_EQ(kNonNegative.Rule(), "must be >= 0");
  EXPECT_EQ(kFraction.Rule(), "must be in [0, 1]");
  EXPECT_EQ((Range{0.0, 0.5, true, false}.Rule()), "must be in (0, 0.5]");
  EXPECT_EQ((Range{-std::numeric_limits<double>::infinity(), 3.0, true, true}.Rule()), "must be < 3");
  EXPECT_EQ((Range{-std::numeric_limits<double>::infinity(), 3.0, true, false}.Rule()), "must be <= 3");
}

TEST(Units, AreTheEndOfAKey) {
  const auto expect = [](const char* key, const char* stem, const char* unit) {
    EXPECT_EQ(SplitUnit(key).stem, stem) << key;
    EXPECT_EQ(SplitUnit(key).unit, unit) << key;
  };
  expect("initial_speed_kmh", "initial_speed", "km/h");
  expect("stiffness_n_per_m", "stiffness", "N/m");
  expect("damping_ns_per_m", "damping", "N s/m");
  expect("rate_kpa_per_s", "rate", "kPa/s");
  expect("curvature_per_m", "curvature", "1/m");
  expect("inertia_kgm2", "inertia", "kg m^2");
  expect("friction_coefficient", "friction_coefficient", "");
  expect("count", "count", "");
  expect("m", "m", "");  // a unit alone is a name
  expect("miles_per", "miles_per", "");
}

// ---------------------------------------------------------------- values

TEST_F(ConfigTest, ReadsEveryVerb) {
  const Scenario s = Read(
      "initial_speed_kmh: 6e1\n"
      "record: false\n"
      "detailed: [0, 2, 1e2]\n"
      "consist:\n"
      "  - count: 2\n"
      "    vehicle: {name: wagon 7, mass_kg: 1e5, coupler: {kind: draw_bar, slack_m: 0}}\n"
      "commands:\n"
      "  - {time_s: 1, reduction_kpa: 50}\n"
      "  - {time_s: 2.5}\n"
      "spare_couplers: [{slack_m: 0.01, stiffness_n_per_m: [1e6, 2e6]}]\n"
      "patch: {friction_coefficient: 0.05}\n");
  EXPECT_EQ(s.initial_speed_kmh, 60.0);
  EXPECT_FALSE(s.record);
  EXPECT_EQ(s.detailed, (std::vector<int>{0, 2, 100}));
  ASSERT_EQ(s.consist.size(), 1u);
  EXPECT_EQ(s.consist[0].count, 2);
  EXPECT_EQ(s.consist[0].vehicle.name, "wagon 7");
  EXPECT_EQ(s.consist[0].vehicle.mass_kg, 1e5);
  EXPECT_EQ(s.consist[0].vehicle.contact.friction_coefficient, 0.3);
  EXPECT_EQ(s.consist[0].vehicle.coupler.kind, CouplerKind::kDrawBar);
  ASSERT_EQ(s.commands.size(), 2u);
  EXPECT_EQ(s.commands[1].time_s, 2.5);
  EXPECT_EQ(s.spare_couplers.at(0).stiffness_n_per_m, (std::vector<double>{1e6, 2e6}));
  ASSERT_TRUE(s.patch);
  EXPECT_EQ(s.patch->friction_coefficient, 0.05);
  EXPECT_FALSE(s.tail);
}

TEST_F(ConfigTest, NumbersAreStrict) {
  EXPECT_EQ(ErrorsOf<Command>("time_s: -0.4\n"), "a.yaml:1: time_s must be >= 0, got -0.4");
  EXPECT_EQ(ErrorsOf<Command>("\n\ntime_s: .nan\n"), "a.yaml:3: time_s must be a finite number, got '.nan'");
  EXPECT_EQ(ErrorsOf<Command>("time_s: \"80\"\n"),
            "a.yaml:1: time_s must be a number without quotes, got '80'");
  EXPECT_EQ(ErrorsOf<Command>("time_s: 3 s\n"),
            "a.yaml:1: time_s must be a plain number in s (the unit is in the key), got '3 s'");
  EXPECT_EQ(ErrorsOf<Command>("time_s: true\n"), "a.yaml:1: time_s must be a number, got 'true'");
  EXPECT_EQ(ErrorsOf<Command>("time_s: [1]\n"), "a.yaml:1: time_s must be a number, got a list");
  EXPECT_EQ(ErrorsOf<Command>("time_s: {a: 1}\n"), "a.yaml:1: time_s must be a number, got a map");
  EXPECT_EQ(ErrorsOf<Command>("time_s:\n"), "a.yaml:1: time_s must be a number, got nothing");
  EXPECT_EQ(ErrorsOf<Command>("reduction_kpa: 50\n"), "a.yaml:1: time_s is missing (must be >= 0)");
}

TEST_F(ConfigTest, IntegersAreWhole) {
  EXPECT_EQ(Read<Stages>("stages: 3.0\n").stages, 3);
  EXPECT_EQ(ErrorsOf<Stages>("stages: 2.5\n"), "a.yaml:1: stages must be a whole number, got 2.5");
  EXPECT_EQ(ErrorsOf<Stages>("stages: 1e10\n"),
            "a.yaml:1: stages must be within the range of an integer, got 1e10");
  EXPECT_EQ(ErrorsOf<Stages>("stages: 0\n"), "a.yaml:1: stages must be > 0, got 0");
  EXPECT_EQ(ErrorsOf<Stages>("{}\n"), "a.yaml:1: stages is missing (must be > 0)");
}

TEST_F(ConfigTest, OtherTypesAreStrict) {
  EXPECT_EQ(ErrorsOf("record: yes\n"), "a.yaml:1: record must be true or false, got 'yes'");
  EXPECT_EQ(ErrorsOf("record: 'true'\n"), "a.yaml:1: record must be true or false, got 'true'");
  EXPECT_EQ(ErrorsOf("detailed: 3\n"), "a.yaml:1: detailed must be a list of whole numbers, got 3");
  EXPECT_EQ(ErrorsOf("detailed:\n  - 1\n  - x\n"), "a.yaml:3: detailed[1] must be a number, got 'x'");
  EXPECT_EQ(ErrorsOf("commands: {time_s: 1}\n"), "a.yaml:1: commands must be a list of maps, got a map");
  EXPECT_EQ(ErrorsOf("commands:\n  - 5\n"), "a.yaml:2: commands[0] must be a map, got 5");
  EXPECT_EQ(ErrorsOf("commands:\n  - ~\n"), "a.yaml:2: commands[0] must be a map, got nothing");
  EXPECT_EQ(ErrorsOf("patch: low\n"), "a.yaml:1: patch must be a map, got 'low'");
  EXPECT_EQ(ErrorsOf("tail: [1]\n"),
            "a.yaml:1: tail must be a map, a file, or a name from couplers/, got a list");
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\nname: [a]\n"),
            "a.yaml:3: name must be text, got a list");
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\ncontact:\n"),
            "a.yaml:3: contact must be a map, got nothing");
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: 0\nkind: draft_gaer\n"),
            "a.yaml:2: kind must be one of draft_gear, draw_bar, got 'draft_gaer'; did you mean draft_gear?");
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: 0\nkind: 3\n"),
            "a.yaml:2: kind must be one of draft_gear, draw_bar, got 3");
}

TEST_F(ConfigTest, MissingValuesPointToTheirMap) {
  EXPECT_EQ(
      ErrorsOf("consist:\n  - count: 1\n    vehicle:\n      name: a\n"),
      "a.yaml:3: consist[0].vehicle.mass_kg is missing (must be > 0)\n"
      "a.yaml:3: consist[0].vehicle.coupler is missing (must be a map, a file, or a name from couplers/)");
  EXPECT_EQ(ErrorsOf("consist:\n  - count: 1\n"),
            "a.yaml:2: consist[0].vehicle is missing (must be a map, a file, or a name from vehicles/)");
}

TEST_F(ConfigTest, NullMeansNoneForOptionalParts) {
  const Scenario s = Read("patch: ~\ntail: null\n");
  EXPECT_FALSE(s.patch);
  EXPECT_FALSE(s.tail);
}

TEST_F(ConfigTest, RulesBetweenFieldsAreJudgedLast) {
  EXPECT_EQ(ErrorsOf<Coupler>("preload_n: 0\nslack_m: 2\n"),
            "a.yaml:2: slack_m must be less than the length of a vehicle, got 2");
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: 2\npreload_n: -1\n"), "a.yaml:2: preload_n must be >= 0, got -1");
}

TEST_F(ConfigTest, AllErrorsInOrderOfLines) {
  EXPECT_EQ(ErrorsOf("initial_speed_mps: 20\n"
                     "commands:\n"
                     "  - {time_s: -1}\n"
                     "  - {tme_s: 2, reduction_kpa: x}\n"
                     "record: 1\n"),
            "a.yaml:1: initial_speed_mps is not a known key; the key is initial_speed_kmh, in km/h\n"
            "a.yaml:3: commands[0].time_s must be >= 0, got -1\n"
            "a.yaml:4: commands[1].time_s is missing (must be >= 0)\n"
            "a.yaml:4: commands[1].reduction_kpa must be a number, got 'x'\n"
            "a.yaml:4: commands[1].tme_s is not a known key; did you mean time_s?\n"
            "a.yaml:5: record must be true or false, got 1");
}

TEST_F(ConfigTest, RootNameLeadsThePath) {
  Put("a.yaml", "initial_speed_mps: 20\n");
  LoadOptions options;
  options.root_name = "scenario";
  options.overrides = {"record=1"};
  LoadFile<Scenario>("a.yaml", options);
  EXPECT_EQ(Errors(),
            "--set record=1: scenario.record must be true or false, got 1\n"
            "a.yaml:1: scenario.initial_speed_mps is not a known key; the key is initial_speed_kmh, in km/h");
}

TEST_F(ConfigTest, ManyErrorsAreCutShort) {
  std::string text = "detailed:\n";
  for (int i = 0; i < 62; ++i) text += "  - x\n";
  const std::string errors = ErrorsOf(text);
  EXPECT_EQ(errors.substr(errors.rfind('\n')), "\nand 12 more");
  EXPECT_EQ(found.size(), 62u);
}

TEST_F(ConfigTest, LoadThrowsAllErrors) {
  const std::string file = Put("a.yaml", "record: 1\ndetailed: 2\n");
  try {
    Load<Scenario>(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(WithoutFolder(error.what()),
              "a.yaml:1: record must be true or false, got 1\n"
              "a.yaml:2: detailed must be a list of whole numbers, got 2");
  }
}

// ---------------------------------------------------------------- suggestions

TEST(Suggestion, NearestOfTheKnownWords) {
  const std::vector<std::string> known{
      "friction_coefficient", "wheel_radius_m", "wheelbase_m", "mass_kg",
      "initial_speed_kmh",    "duration_s",     "dt_s",        "exchange_interval_s"};
  EXPECT_EQ(Nearest("frction", known), "friction_coefficient");
  EXPECT_EQ(Nearest("friction_coeficient", known), "friction_coefficient");
  EXPECT_EQ(Nearest("coefficient", known), "friction_coefficient");
  EXPECT_EQ(Nearest("weel_radius_m", known), "wheel_radius_m");
  EXPECT_EQ(Nearest("wheel_raduis_m", known), "wheel_radius_m");
  EXPECT_EQ(Nearest("Wheel-Radius-M", known), "wheel_radius_m");
  EXPECT_EQ(Nearest("wheel_base_m", known), "wheelbase_m");
  EXPECT_EQ(Nearest("inital_speed_mps", known), "initial_speed_kmh");
  EXPECT_EQ(Nearest("mas_kg", known), "mass_kg");
  EXPECT_EQ(Nearest("total_mass_kg", known), "mass_kg");
  EXPECT_EQ(Nearest("ds_t", known), "");
  EXPECT_EQ(Nearest("colour", known), "");
  EXPECT_EQ(Nearest(std::string(100000, 'a'), known), "");
  EXPECT_EQ(Nearest("x", {}), "");
}

TEST(Suggestion, HintsForKeys) {
  EXPECT_EQ(KeyHint("speed_mps", {"speed_kmh"}), "; the key is speed_kmh, in km/h");
  EXPECT_EQ(KeyHint("speed", {"speed_kmh"}), "; the key is speed_kmh, in km/h");
  EXPECT_EQ(KeyHint("friction_n", {"friction"}), "; the key is friction, without a unit");
  EXPECT_EQ(KeyHint("stiffness_kn_per_mm", {"stiffness_n_per_m"}), "; the key is stiffness_n_per_m, in N/m");
  EXPECT_EQ(KeyHint("colour", {"mass_kg", "count"}), "; known keys: mass_kg, count");
  EXPECT_EQ(KeyHint("colour", {}), "");
}

TEST_F(ConfigTest, UnknownKeysOfAGroup) {
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\ncontact:\n  frction: 0.1\n"),
            "a.yaml:4: contact.frction is not a known key; did you mean friction_coefficient?");
  EXPECT_EQ(ErrorsOf<Contact>("base_friction: 1\n<<: {a: 1}\n"),
            "a.yaml:1: base_friction is not a known key; known keys: friction_coefficient\n"
            "a.yaml:2: << is not a known key; known keys: friction_coefficient");
}

// ---------------------------------------------------------------- documents

TEST_F(ConfigTest, FilesThatCannotBeRead) {
  LoadFile<Scenario>("none.yaml");
  EXPECT_EQ(Errors(), "none.yaml: does not exist");
  fs::create_directory(root / "dir.yaml");
  LoadFile<Scenario>("dir.yaml");
  EXPECT_EQ(Errors(), "dir.yaml: is a folder, not a file");
  ASSERT_EQ(mkfifo((root / "pipe.yaml").c_str(), 0600), 0);
  LoadFile<Scenario>("pipe.yaml");
  EXPECT_EQ(Errors(), "pipe.yaml: is not a regular file");
  if (geteuid() != 0) {  // root may read everything
    fs::permissions(Put("secret.yaml", "{}"), fs::perms::none);
    LoadFile<Scenario>("secret.yaml");
    EXPECT_EQ(Errors(), "secret.yaml: cannot be read: Permission denied");
  }
  Put("file", "");
  LoadFile<Scenario>("file/a.yaml");
  EXPECT_EQ(Errors(), "file/a.yaml: does not exist");
}

TEST_F(ConfigTest, FilesThatAreNotYaml) {
  EXPECT_EQ(ErrorsOf(""), "a.yaml:1: must hold a map of keys and values, got nothing");
  EXPECT_EQ(ErrorsOf("# only a comment\n"), "a.yaml:1: must hold a map of keys and values, got nothing");
  EXPECT_EQ(ErrorsOf("just text\n"), "a.yaml:1: must hold a map of keys and values, got 'just text'");
  EXPECT_EQ(ErrorsOf("- 1\n"), "a.yaml:1: must hold a map of keys and values, got a list");
  EXPECT_EQ(ErrorsOf(std::string("a: 1\nb: \0", 9)),
            "a.yaml:2: is not a text file (it contains a zero byte)");
  EXPECT_EQ(ErrorsOf("\x7f"
                     "ELF\x02"),
            "a.yaml:1: is not a text file (it contains a control character)");
  EXPECT_EQ(ErrorsOf("a: 1\nb: \xff\n"), "a.yaml:2: is not a text file in UTF-8");
  EXPECT_EQ(ErrorsOf("a: \xc0\x80\n"), "a.yaml:1: is not a text file in UTF-8");
  EXPECT_EQ(ErrorsOf("a: \xe2\x82"), "a.yaml:1: is not a text file in UTF-8");
}

TEST_F(ConfigTest, TextsMayNotCommandTerminals) {
  for (const std::string escape :
       {"\\e[31m", "\\0", "\\a", "\\x7f", "\\x9b2J", "\\u202e", "\\u2066", "\\r"}) {
    const std::string errors = ErrorsOf("consist:\n  - vehicle: {name: \"a" + escape + "b\"}\n");
    EXPECT_NE(
        errors.find("a.yaml:2: consist[0].vehicle.name must be text without control characters, got 'a"),
        std::string::npos)
        << escape << ": " << errors;
    EXPECT_EQ(errors.find('\0'), std::string::npos) << "cut there by what takes C strings";
  }
  for (const std::string escape : {"\\n", "\\t", "\\xfc", "\\u00a0", "\\u202f", "$x_1$ # % \\U0001F682"})
    EXPECT_EQ(ErrorsOf("consist:\n  - vehicle: {name: \"a" + escape + "b\"}\n").find("control"),
              std::string::npos)
        << escape;
}

TEST_F(ConfigTest, SyntaxErrorsNameTheirLine) {
  EXPECT_EQ(ErrorsOf("record: true\ndetailed: [1, 2\n"),
            "a.yaml:3: is not valid YAML: end of sequence flow not found");
  EXPECT_EQ(ErrorsOf("patch:\n\tfriction_coefficient: 1\n"),
            "a.yaml:2: is indented with a tab; indent with spaces");
  EXPECT_EQ(ErrorsOf("record: true\n---\nrecord: false\n"),
            "a.yaml:3: begins a second document; a file holds one");
  EXPECT_EQ(ErrorsOf("record: !!bool true\n"),
            "a.yaml:1: has the tag 'tag:yaml.org,2002:bool'; tags are not supported");
  EXPECT_EQ(ErrorsOf("[a]: 1\n"),
            "a.yaml:1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(ErrorsOf("? {a: 1}\n: 1\n"),
            "a.yaml:1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(ErrorsOf("~: 1\n"), "a.yaml:1: a key must be plain text");
  EXPECT_EQ(ErrorsOf("record: *nowhere\n"),
            "a.yaml:1: is not valid YAML: the referenced anchor is not defined");
  EXPECT_EQ(ErrorsOf("a: b: c\n"), "a.yaml:1: is not valid YAML: illegal map value");
}

TEST_F(ConfigTest, WindowsFilesAndComments) {
  const Command c = Read<Command>(
      "\xEF\xBB\xBF# comment\r\ntime_s: 1 # s\r\n\t# tab before a comment\r\nreduction_kpa: 2\r\n");
  EXPECT_EQ(c.time_s, 1.0);
  EXPECT_EQ(c.reduction_kpa, 2.0);
  EXPECT_EQ(ErrorsOf<Command>("a: 1\r\n\r\ntime_s: x\r\n"),
            "a.yaml:1: a is not a known key; known keys: time_s, reduction_kpa\n"
            "a.yaml:3: time_s must be a number, got 'x'");
}

TEST_F(ConfigTest, DuplicateKeys) {
  EXPECT_EQ(ErrorsOf("record: true\n"
                     "commands:\n"
                     "  - {time_s: 1}\n"
                     "  - time_s: 1\n"
                     "    reduction_kpa: 5\n"
                     "    time_s: 2\n"
                     "record: x\n"),
            "a.yaml:6: commands[1].time_s is given twice, first in line 4\n"
            "a.yaml:7: record is given twice, first in line 1");
}

TEST_F(ConfigTest, Aliases) {
  const Scenario s = Read("commands: [&first {time_s: 1}, *first]\n");
  ASSERT_EQ(s.commands.size(), 2u);
  EXPECT_EQ(s.commands[1].time_s, 1.0);
  EXPECT_EQ(ErrorsOf("commands: &c [*c]\n"), "a.yaml:1: an alias refers to the value that it is part of");
}

TEST_F(ConfigTest, BombsAreRefused) {
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int j = 1; j < 10; ++j) laughs += ", " + last;
    laughs += "]\n";
  }
  EXPECT_EQ(ErrorsOf(laughs), "a.yaml:7: holds more than 3000000 values");

  std::string text = "big: &big " + std::string(1 << 20, 'x') + "\nlist:\n";
  for (int i = 0; i < 70; ++i) text += "  - *big\n";
  EXPECT_EQ(ErrorsOf(text), "a.yaml:65: holds more than 64 MB of text once its aliases are expanded");

  EXPECT_EQ(ErrorsOf("a: " + std::string(100000, '[')),
            "a.yaml:1: has a list or map in the place of a key (is a bracket left open?)");
  std::string deep = "a:\n";
  for (int i = 0; i < 10000; ++i) deep += " [\n";
  for (int i = 0; i < 10000; ++i) deep += " ]\n";
  EXPECT_EQ(ErrorsOf(deep), "a.yaml:65: is nested deeper than 64 levels");
  EXPECT_EQ(
      ErrorsOf("a: " + std::string(63, '[') + "1" + std::string(63, ']')),
      "a.yaml:1: a is not a known key; known keys: initial_speed_kmh, record, detailed, consist, commands, "
      "spare_couplers, patch, tail");
  std::string ladder = "a0: &a0 [x]\n";
  for (int i = 1; i < 70; ++i) {
    ladder += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  }
  EXPECT_EQ(ErrorsOf(ladder), "a.yaml:64: is nested deeper than 64 levels");

  EXPECT_EQ(ErrorsOf(std::string((64 << 20) + 1, ' ')),
            "a.yaml: is larger than 64 MB, the limit for such a file");
}

TEST_F(ConfigTest, HugeListsOfMapsAreRefused) {
  std::string text = "commands: [";
  for (int i = 0; i < 200001; ++i) text += "{},";
  EXPECT_EQ(ErrorsOf(text + "]\n"), "a.yaml:1: commands has 200001 entries; the limit is 200000");
}

TEST_F(ConfigTest, PartsThatUnfoldWithoutBoundAreRefused) {
  // 200 parts of 200 parts of 200 parts: eight million from four small files.
  std::string list;
  for (int level = 0; level < 4; ++level) {
    Put("assemblies/l" + std::to_string(level) + ".yaml", "mass_kg: 1\n" + list);
    list = "parts: [l" + std::to_string(level);
    for (int i = 1; i < 200; ++i) list += ", l" + std::to_string(level);
    list += "]\n";
  }
  LoadFile<Assembly>("assemblies/l3.yaml");
  EXPECT_NE(Errors().find("unfolds, through its references, to more values than are read"),
            std::string::npos);
  EXPECT_LT(found.size(), 10u);
}

TEST_F(ConfigTest, MutatedFilesNeverCrash) {
  const std::string seed =
      "# head\nbase: other\ninitial_speed_kmh: 60 # km/h\nrecord: !!bool false\ndetailed: [0, 2, 1e2]\n"
      "consist:\n  - count: 2\n    vehicle: {name: \"wagon \\x41\", mass_kg: 1e5, coupler: &c {slack_m: 0}}\n"
      "  - vehicle:\n      name: |\n        block\n      mass_kg: '5'\n      coupler: *c\n"
      "commands:\n- {time_s: 1, reduction_kpa: 50}\n- ? time_s\n  : 2.5\n%TAG ! x\n--- >-\n text\n...\n";
  const std::string pieces[] = {"[",        "]",
                                "{",        "}",
                                ":",        "- ",
                                "? ",       "&a ",
                                "*a",       "!",
                                "!!",       "!<x>",
                                "%",        "---",
                                "...",      "|",
                                ">",        "'",
                                "\"",       "\\",
                                "#",        ",",
                                "\n",       "  ",
                                "\t",       "\r",
                                "~",        "<<: ",
                                "@",        "`",
                                "{:",       "[:",
                                "\xc3\xa9", "\xef\xbb\xbf",
                                "0x",       "nan",
                                "-",        "%YAML 1.2\n",
                                "base: a\n"};
  std::mt19937 random(7);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (int round = 0; round < 3000; ++round) {
    std::string text = seed;
    for (std::size_t edit = 0; edit <= pick(6); ++edit) {
      const std::size_t at = pick(text.size() + 1);
      switch (pick(4)) {
        case 0:
          text.insert(at, pieces[pick(std::size(pieces))]);
          break;
        case 1:
          text.erase(at, pick(12));
          break;
        case 2:
          text.resize(at);
          break;
        default:
          text.insert(at, text.substr(pick(text.size() + 1), pick(40)));
      }
    }
    // The point is that this returns; an unchanged reading without errors is as good as a complaint.
    Put("a.yaml", text);
    LoadFile<Scenario>("a.yaml");
  }
}

// ---------------------------------------------------------------- parts

class PartsTest : public ConfigTest {
 protected:
  void SetUp() override {
    ConfigTest::SetUp();
    Put("couplers/f_type.yaml", "slack_m: 0.01\npreload_n: 100\nstiffness_n_per_m: [1, 2]\n");
    Put("couplers/g_type.yaml", "base: f_type\nslack_m: 0.02\nstiffness_n_per_m: [3]\n");
    Put("vehicles/wagon.yaml",
        "name: wagon\nmass_kg: 100000\ncontact: {friction_coefficient: 0.2}\ncoupler: f_type\n");
  }
};

TEST_F(PartsTest, ByNameFromSiblingFolders) {
  Put("scenarios/s.yaml", "consist:\n  - vehicle: wagon\ntail: g_type\n");
  const Scenario s = LoadFile<Scenario>("scenarios/s.yaml");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(s.consist.at(0).vehicle.name, "wagon");
  EXPECT_EQ(s.consist.at(0).vehicle.coupler.slack_m, 0.01);
  ASSERT_TRUE(s.tail);
  EXPECT_EQ(s.tail->slack_m, 0.02);
  EXPECT_EQ(s.tail->preload_n, 100.0);                               // from f_type
  EXPECT_EQ(s.tail->stiffness_n_per_m, (std::vector<double>{3.0}));  // a list replaces
}

TEST_F(PartsTest, ByFileRelativeToTheReference) {
  Put("else/where/s.yaml",
      "consist:\n  - vehicle: ../w.yaml\nspare_couplers: [../../couplers/f_type.yaml, f_type]\n");
  Put("else/w.yaml", "mass_kg: 5\ncoupler: c.yml\n");
  Put("else/c.yml", "slack_m: 0.5\n");
  const Scenario s = LoadFile<Scenario>("else/where/s.yaml");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(s.consist.at(0).vehicle.coupler.slack_m, 0.5);
  EXPECT_EQ(s.spare_couplers.at(0).slack_m, 0.01);
  EXPECT_EQ(s.spare_couplers.at(1).slack_m, 0.01);
}

TEST_F(PartsTest, FromSearchRoots) {
  fs::create_directories(root / "home");
  Put("share/buffers/x.yaml", "");
  Put("share/couplers/h_type.yaml", "slack_m: 0.03\n");
  Put("home/s.yaml", "tail: h_type\n");
  LoadOptions options;
  options.search_roots = {root / "share"};
  EXPECT_EQ(LoadFile<Scenario>("home/s.yaml", options).tail.value().slack_m, 0.03);
  EXPECT_EQ(Errors(), "");

  setenv("PARTS_OF_THIS_TEST", "/a::/b/c", 1);
  EXPECT_EQ(FoldersInEnvironment("PARTS_OF_THIS_TEST"), (std::vector<fs::path>{"/a", "/b/c"}));
  unsetenv("PARTS_OF_THIS_TEST");
  EXPECT_TRUE(FoldersInEnvironment("PARTS_OF_THIS_TEST").empty());
}

TEST_F(PartsTest, UnknownReferences) {
  Put("share/couplers/h_type.yaml", "slack_m: 0.03\n");
  Put("scenarios/s.yaml", "tail: f_typ\nspare_couplers: [x/y.yaml, 'a b', '']\n");
  LoadOptions options;
  options.search_roots = {root / "share"};
  options.search_remedy = "set MY_PARTS to a folder of parts";
  LoadFile<Scenario>("scenarios/s.yaml", options);
  EXPECT_EQ(
      Errors(),
      "scenarios/s.yaml:1: tail names 'f_typ', but there is no f_typ.yaml in couplers, share/couplers; "
      "did you mean f_type? (there: f_type, g_type, h_type)\n"
      "scenarios/s.yaml:2: spare_couplers[0] names the file 'x/y.yaml', but there is no scenarios/x/y.yaml\n"
      "scenarios/s.yaml:2: spare_couplers[1] must be a map, a file, or a name from couplers/, got 'a b'\n"
      "scenarios/s.yaml:2: spare_couplers[2] must be a map, a file, or a name from couplers/, got ''");

  Put("scenarios/a.yaml", "mass_kg: 1\nparts: [b]\n");
  LoadFile<Assembly>("scenarios/a.yaml", options);
  EXPECT_EQ(
      Errors(),
      "scenarios/a.yaml:2: parts[0] names 'b', but there is no folder assemblies in scenarios or above it, "
      "nor in " +
          WithoutFolder(options.search_roots[0].string()) +
          "; or give a file, or set MY_PARTS to a folder of parts");
}

TEST_F(PartsTest, ErrorsInAPartNameItsFileAndTheWholePath) {
  Put("couplers/bad.yaml", "slack_m: -1\npreload_kn: 3\n");
  Put("vehicles/bad.yaml", "mass_kg: 1\ncoupler: bad\n");
  Put("s.yaml", "consist:\n  - vehicle: bad\n  - vehicle: bad\n  - vehicle: {base: bad, mass_kg: 0}\n");
  LoadFile<Scenario>("s.yaml");
  // The two errors of the coupler are said once, not once for each of the vehicles.
  EXPECT_EQ(Errors(),
            "couplers/bad.yaml:1: consist[0].vehicle.coupler.slack_m must be >= 0, got -1\n"
            "couplers/bad.yaml:2: consist[0].vehicle.coupler.preload_kn is not a known key; "
            "the key is preload_n, in N\n"
            "s.yaml:4: consist[2].vehicle.mass_kg must be > 0, got 0");
}

TEST_F(PartsTest, MissingValuesOfAPart) {
  Put("couplers/empty.yaml", "preload_n: 1\n");
  Put("s.yaml", "\ntail: empty\nspare_couplers:\n  - base: empty\n");
  LoadFile<Scenario>("s.yaml");
  EXPECT_EQ(Errors(),
            "s.yaml:4: spare_couplers[0].slack_m is missing (must be >= 0)\n"
            "couplers/empty.yaml:1: tail.slack_m is missing (must be >= 0)");
}

TEST_F(PartsTest, BaseMergesKeyByKey) {
  Put("scenarios/first.yaml",
      "initial_speed_kmh: 50\ndetailed: [1, 2]\nconsist: [{vehicle: wagon}]\npatch: {friction_coefficient: "
      "0.1}\n");
  Put("scenarios/second.yaml", "base: first\ndetailed: [3]\nrecord: false\n");
  Put("scenarios/third.yaml", "base: ./second.yaml\ninitial_speed_kmh: -1\n");
  const Scenario s = LoadFile<Scenario>("scenarios/second.yaml");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(s.initial_speed_kmh, 50.0);
  EXPECT_EQ(s.detailed, (std::vector<int>{3}));
  EXPECT_FALSE(s.record);
  EXPECT_EQ(s.patch.value().friction_coefficient, 0.1);
  LoadFile<Scenario>("scenarios/third.yaml");
  EXPECT_EQ(Errors(), "scenarios/third.yaml:2: initial_speed_kmh must be >= 0, got -1");
}

TEST_F(PartsTest, AMapOverANameModifiesThatPart) {
  Put("scenarios/first.yaml", "tail: f_type\n");
  Put("scenarios/second.yaml", "base: first\ntail: {slack_m: 0}\n");
  Put("scenarios/third.yaml", "base: second\ntail: {kind: draw_bar}\n");
  const Scenario s = LoadFile<Scenario>("scenarios/third.yaml");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(s.tail.value().slack_m, 0.0);
  EXPECT_EQ(s.tail.value().preload_n, 100.0);
  EXPECT_EQ(s.tail.value().kind, CouplerKind::kDrawBar);

  Put("scenarios/fourth.yaml", "base: third\ntail: {base: g_type}\n");
  EXPECT_EQ(LoadFile<Scenario>("scenarios/fourth.yaml").tail.value().slack_m, 0.02);
  EXPECT_EQ(Errors(), "");
  Put("scenarios/fifth.yaml", "base: third\ntail: g_type\n");
  EXPECT_EQ(LoadFile<Scenario>("scenarios/fifth.yaml").tail.value().slack_m, 0.02);
  EXPECT_EQ(Errors(), "");
}

TEST_F(PartsTest, BaseMustBeAReference) {
  Put("s.yaml", "tail: {base: [a]}\n");
  LoadFile<Scenario>("s.yaml");
  EXPECT_EQ(Errors(), "s.yaml:1: tail.base must be a file, or a name from couplers/, got a list");
}

TEST_F(PartsTest, CyclesAreShown) {
  Put("couplers/a.yaml", "base: b\n");
  Put("couplers/b.yaml", "base: ./c.yaml\n");
  Put("couplers/c.yaml", "slack_m: 1\nbase: a\n");
  Put("s.yaml", "tail: a\n");
  LoadFile<Scenario>("s.yaml");
  EXPECT_EQ(Errors(),
            "couplers/c.yaml:2: tail.base includes a file in itself: "
            "couplers/a.yaml -> couplers/b.yaml -> couplers/c.yaml -> couplers/a.yaml");
  Put("self.yaml", "base: self.yaml\n");
  LoadFile<Scenario>("self.yaml");
  EXPECT_EQ(Errors(), "self.yaml:1: base includes a file in itself: self.yaml -> self.yaml");
  Put("assemblies/x.yaml", "parts: [y]\n");
  Put("assemblies/y.yaml", "parts:\n  - parts: []\n  - base: x\n");
  LoadFile<Assembly>("assemblies/x.yaml");
  EXPECT_EQ(Errors(),
            "assemblies/y.yaml:3: parts[0].parts[1].base includes a file in itself: "
            "assemblies/x.yaml -> assemblies/y.yaml -> assemblies/x.yaml");
}

TEST_F(PartsTest, EndlessChainsOfFilesAreCut) {
  for (int i = 0; i < 80; ++i) {
    Put("couplers/n" + std::to_string(i) + ".yaml", "base: n" + std::to_string(i + 1) + "\n");
  }
  Put("s.yaml", "tail: n0\n");
  LoadFile<Scenario>("s.yaml");
  EXPECT_NE(Errors().find("is reached through more than 64 others"), std::string::npos) << Errors();
}

// ---------------------------------------------------------------- overrides

TEST_F(PartsTest, OverridesReachEverywhere) {
  Put("s.yaml",
      "initial_speed_kmh: x\nconsist: [{vehicle: wagon}, {vehicle: wagon}]\ncommands: [{time_s: 1}]\n");
  LoadOptions options;
  options.overrides = {"initial_speed_kmh=70",
                       "consist[1].vehicle.coupler.slack_m=0.5",
                       "consist[0].vehicle.contact={friction_coefficient: 0.9}",
                       "consist[0].vehicle.coupler=g_type",
                       "commands[0].time_s=2",
                       "commands[0].time_s=3",
                       "detailed=[4, 5]",
                       "detailed[1]=6",
                       "patch.friction_coefficient=0.4",
                       "tail.slack_m=0.6"};
  const Scenario s = LoadFile<Scenario>("s.yaml", options);
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(s.initial_speed_kmh, 70.0);
  EXPECT_EQ(s.consist.at(0).vehicle.coupler.slack_m, 0.02);
  EXPECT_EQ(s.consist.at(1).vehicle.coupler.slack_m, 0.5);
  EXPECT_EQ(s.consist.at(1).vehicle.coupler.preload_n, 100.0);
  EXPECT_EQ(s.consist.at(0).vehicle.contact.friction_coefficient, 0.9);
  EXPECT_EQ(s.commands.at(0).time_s, 3.0);  // the last one counts
  EXPECT_EQ(s.detailed, (std::vector<int>{4, 6}));
  EXPECT_EQ(s.patch.value().friction_coefficient, 0.4);
  EXPECT_EQ(s.tail.value().slack_m, 0.6);
}

TEST_F(PartsTest, WrongOverridesNameThemselves) {
  const std::string text = "commands: [{time_s: 1}, {time_s: 2}]\ntail: f_type\n";
  EXPECT_EQ(ErrorsOf(text, {"tail.slack_m=-1"}), "--set tail.slack_m=-1: tail.slack_m must be >= 0, got -1");
  EXPECT_EQ(ErrorsOf(text, {"tail.slack_mm=10"}),
            "--set tail.slack_mm=10: tail.slack_mm is not a known key; the key is slack_m, in m");
  EXPECT_EQ(ErrorsOf(text, {"tial.slack_m=10"}),
            "--set tial.slack_m=10: tial is not a known key; did you mean tail?");
  EXPECT_EQ(ErrorsOf(text, {"commands[2].time_s=1"}),
            "--set commands[2].time_s=1: commands has no entry 2; its entries are 0 to 1");
  EXPECT_EQ(ErrorsOf(text, {"commands[99999999999999999999].time_s=1"}),
            "--set commands[99999999999999999999].time_s=1: commands has no entry 99999999999999999999; "
            "its entries are 0 to 1");
  EXPECT_EQ(ErrorsOf(text, {"commands.time_s=1"}),
            "--set commands.time_s=1: commands has no entry time_s; its entries are 0 to 1");
  EXPECT_EQ(ErrorsOf(text, {"detailed[0]=1"}), "--set detailed[0]=1: detailed has no entry 0; it has none");
  EXPECT_EQ(ErrorsOf(text, {"record.x=1"}), "--set record.x=1: record.x names no value of the configuration");
  EXPECT_EQ(ErrorsOf(text, {"record="}), "--set record=: record must be true or false, got nothing");
  EXPECT_EQ(ErrorsOf(text, {"record"}), "--set record: must be a path, '=' and a value, as in name=mine");
  for (const char* path :
       {"=1", ".a=1", "a.=1", "a..b=1", "a[=1", "a[x]=1", "a[]=1", "a]=1", "a b=1", "[0]=1"}) {
    EXPECT_NE(ErrorsOf(text, {path}).find("must be a path, '=' and a value"), std::string::npos) << path;
  }
  EXPECT_EQ(ErrorsOf(text, {"detailed=[1"}),
            "--set detailed=[1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(
      ErrorsOf(text, {"tail=h_type"}),
      "--set tail=h_type: tail names 'h_type', but there is no h_type.yaml in couplers; did you mean f_type? "
      "(there: f_type, g_type)");
}

TEST_F(PartsTest, OverridesAfterOtherErrorsAreNotBlamed) {
  EXPECT_EQ(ErrorsOf("tail: none.yaml\n", {"tail.slack_m=1"}),
            "a.yaml:1: tail names the file 'none.yaml', but there is no none.yaml");
}

// ---------------------------------------------------------------- writing

TEST_F(PartsTest, WriteReadWriteIsIdentical) {
  Put("s.yaml",
      "initial_speed_kmh: 0.30000000000000004\nrecord: false\ndetailed: [0, 241]\n"
      "consist:\n  - vehicle: wagon\n  - {count: 3, vehicle: {base: wagon, name: \"no: [a]\\n\\tb \\\"q\\\" "
      "\\\\ é\"}}\n"
      "commands: [{time_s: 1e-300}, {time_s: 123456789.125, reduction_kpa: 50}]\n"
      "spare_couplers: [f_type, g_type]\ntail: {slack_m: -0.0, kind: draw_bar}\n");
  const Scenario s = LoadFile<Scenario>("s.yaml");
  ASSERT_EQ(Errors(), "");
  const std::string first = Write(s);
  EXPECT_EQ(Write(Read(first)), first);
  EXPECT_EQ(first,
            "initial_speed_kmh: 0.30000000000000004\n"
            "record: false\n"
            "detailed: [0, 241]\n"
            "consist:\n"
            "  - count: 1\n"
            "    vehicle:\n"
            "      name: wagon\n"
            "      mass_kg: 100000\n"
            "      contact:\n"
            "        friction_coefficient: 0.2\n"
            "      coupler:\n"
            "        kind: draft_gear\n"
            "        slack_m: 0.01\n"
            "        preload_n: 100\n"
            "        stiffness_n_per_m: [1, 2]\n"
            "  - count: 3\n"
            "    vehicle:\n"
            "      name: \"no: [a]\\x0A\\x09b \\\"q\\\" \\\\ é\"\n"
            "      mass_kg: 100000\n"
            "      contact:\n"
            "        friction_coefficient: 0.2\n"
            "      coupler:\n"
            "        kind: draft_gear\n"
            "        slack_m: 0.01\n"
            "        preload_n: 100\n"
            "        stiffness_n_per_m: [1, 2]\n"
            "commands:\n"
            "  - {time_s: 1e-300, reduction_kpa: 0}\n"
            "  - {time_s: 123456789.125, reduction_kpa: 50}\n"
            "spare_couplers:\n"
            "  - kind: draft_gear\n"
            "    slack_m: 0.01\n"
            "    preload_n: 100\n"
            "    stiffness_n_per_m: [1, 2]\n"
            "  - kind: draft_gear\n"
            "    slack_m: 0.02\n"
            "    preload_n: 100\n"
            "    stiffness_n_per_m: [3]\n"
            "patch: null\n"
            "tail:\n"
            "  kind: draw_bar\n"
            "  slack_m: -0\n"
            "  preload_n: 0\n"
            "  stiffness_n_per_m: []\n");
}

TEST_F(ConfigTest, AnyTextSurvivesARoundTrip) {
  for (const std::string text :
       {"",     "plain", "two words", "12",     "true",         "NULL",  "~",  "- a", "a: b", "#x",
        "a #b", " lead", "trail ",    "x\ny\n", "it's",         "\"q\"", "\\", "{a}", "ünï",  "\t",
        "*a",   "&a",    "!t",        "a,b",    "path/to.yaml", "@",     "%",  "---", "..."}) {
    Vehicle vehicle;
    vehicle.name = text;
    vehicle.mass_kg = 1.0;
    vehicle.coupler.slack_m = 0.0;
    EXPECT_EQ(Read<Vehicle>(Write(vehicle)).name, text);
  }
}

TEST_F(ConfigTest, RandomDoublesSurviveARoundTrip) {
  std::mt19937_64 random(2);
  Coupler coupler;
  coupler.slack_m = 0.0;
  while (coupler.stiffness_n_per_m.size() < 5000) {
    const std::uint64_t bits = random() >> 1;  // not negative
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value) && value > 0.0) coupler.stiffness_n_per_m.push_back(value);
  }
  EXPECT_EQ(Read<Coupler>(Write(coupler)).stiffness_n_per_m, coupler.stiffness_n_per_m);
}

TEST_F(ConfigTest, AnEmptyScenarioIsTheDefault) {
  const std::string text = Write(Scenario());
  EXPECT_EQ(Write(Read(text)), text);
}

// ---------------------------------------------------------------- in code

TEST(Validation, SaysTheSameAsTheReader) {
  Scenario s;
  s.initial_speed_kmh = -1.0;
  s.detailed = {1, -2};
  s.consist.resize(1);
  s.consist[0].count = 0;
  s.consist[0].vehicle.mass_kg = -0.4;
  s.tail.emplace();
  s.spare_couplers.resize(1);
  s.spare_couplers[0].slack_m = 2.0;
  s.spare_couplers[0].kind = static_cast<CouplerKind>(7);
  s.patch.emplace().friction_coefficient = 2.0;
  try {
    Validate(s);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "initial_speed_kmh must be >= 0, got -1\n"
                 "detailed[1] must be >= 0, got -2\n"
                 "consist[0].count must be in [1, 1000], got 0\n"
                 "consist[0].vehicle.mass_kg must be > 0, got -0.4\n"
                 "consist[0].vehicle.coupler.slack_m is missing (must be >= 0)\n"
                 "spare_couplers[0].kind must be one of its named values\n"
                 "patch.friction_coefficient must be in [0, 1], got 2\n"
                 "tail.slack_m is missing (must be >= 0)");
  }
  EXPECT_THROW(Write(s), std::invalid_argument);
  EXPECT_THROW(Validate(Stages()), std::invalid_argument);
  EXPECT_NO_THROW(Validate(Scenario()));
}

TEST(Validation, RulesBetweenFields) {
  Coupler coupler;
  coupler.slack_m = 2.0;
  try {
    Validate(coupler);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "slack_m must be less than the length of a vehicle");
  }
}

// ---------------------------------------------------------------- tables

class CsvTest : public ConfigTest {
 protected:
  CsvTable ReadTable(const std::string& text) {
    found = ErrorList();
    return ReadCsvTable(Put("t.csv", text), found);
  }
  std::string ErrorsOfTable(const std::string& text) {
    ReadTable(text);
    return Errors();
  }
};

TEST_F(CsvTest, ReadsColumns) {
  const CsvTable table =
      ReadTable("\xEF\xBB\xBF# a comment\r\n\r\ntime_s, pressure_kpa\r\n0, 500\r\n# more\r\n 1e-1 ,4.5e2");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"time_s", "pressure_kpa"}));
  EXPECT_EQ(table.values, (std::vector<std::vector<double>>{{0.0, 0.1}, {500.0, 450.0}}));
  EXPECT_EQ(table.row_lines, (std::vector<int>{4, 6}));
  EXPECT_EQ(table.header_line, 3);
  EXPECT_EQ(table.Column("pressure_kpa", found), &table.values[1]);
  EXPECT_EQ(table.Column("pressure_pa", found), nullptr);
  EXPECT_EQ(Errors(), "t.csv:3: has no column pressure_pa; the column is pressure_kpa, in kPa");
}

TEST_F(CsvTest, ErrorsNameTheirLines) {
  EXPECT_EQ(ErrorsOfTable("time_s,pressure_kpa\n0\n1,2,3\nx,\n2,nan\n3,4 kPa\n4,5,6,\n"),
            "t.csv:2: has 1 values, but the header names 2 columns\n"
            "t.csv:3: has 3 values, but the header names 2 columns\n"
            "t.csv:4: time_s must be a number, got 'x'\n"
            "t.csv:4: pressure_kpa must be a number, got nothing\n"
            "t.csv:5: pressure_kpa must be a finite number, got 'nan'\n"
            "t.csv:6: pressure_kpa must be a plain number in kPa (the unit is in the key), got '4 kPa'\n"
            "t.csv:7: has 4 values, but the header names 2 columns");
  EXPECT_EQ(ErrorsOfTable(""), "t.csv: is empty: a table begins with a line that names its columns");
  EXPECT_EQ(ErrorsOfTable("a,b\n"), "t.csv:1: names columns, but no line of numbers follows");
  EXPECT_EQ(ErrorsOfTable("a,,a,3\n1,2,3,4\n"),
            "t.csv:1: column 2 has no name\n"
            "t.csv:1: column a is given twice\n"
            "t.csv:1: must name the columns, got 3 for column 4");
  EXPECT_EQ(ErrorsOfTable(std::string(20000, ',')), "t.csv:1: has more than 10000 columns");
  EXPECT_EQ(ErrorsOfTable("a\n" + std::string(20000, ',')),
            "t.csv:2: has more than 10000 values, but the header names 1 columns");
  EXPECT_EQ(ErrorsOfTable(std::string("a\n\0", 3)), "t.csv:2: is not a text file (it contains a zero byte)");
  EXPECT_EQ(
      ErrorsOfTable("a,b\n\"1,2\n3,\"4\" 5\n"),
      "t.csv:2: has a quote that does not end, or text behind its end: \"1,2 (a quote within quotes is "
      "written twice)\n"
      "t.csv:3: has a quote that does not end, or text behind its end: \"4\" 5 (a quote within quotes is "
      "written twice)");
  ReadCsvTable((root / "none.csv").string(), found = ErrorList());
  EXPECT_EQ(Errors(), "none.csv: does not exist");
}

TEST_F(CsvTest, TakesWhatSpreadsheetsWrite) {
  const std::vector<std::vector<double>> expected = {{0.0, 0.1}, {500.0, -450.0}};
  const char* const texts[] = {
      "\"time_s\",\"pressure_kpa\"\n\"0\",500\n0.1, \"-450\" \n",  // quoted
      "time_s,pressure_kpa,\r\n0,500,\r\n0.1,-450,\r\n",           // closed by commas
      "time_s,pressure_kpa\n0,500,\n0.1,-450\n",                   // only some lines are
      "time_s;pressure_kpa\n0;500\n0.1;-450\n",                    // semicolons
      "\"time_s\"\t\"pressure_kpa\"\n0\t500\n0.1\t-450\n",         // tabs
  };
  for (const char* const text : texts) {
    const CsvTable table = ReadTable(text);
    EXPECT_EQ(Errors(), "") << text;
    EXPECT_EQ(table.columns, (std::vector<std::string>{"time_s", "pressure_kpa"})) << text;
    EXPECT_EQ(table.values, expected) << text;
  }
  EXPECT_EQ(ReadTable("\"a, \"\"b\"\"\"\n1\n").columns, (std::vector<std::string>{"a, \"b\""}));
}

TEST_F(CsvTest, AListOfMapsMayBeATable) {
  Put("parts/brakes.csv", "reduction_kpa,note,time_s\n# pressures\n50,\"first, gently\",0\n,,12.5\n");
  const Scenario scenario =
      Read("consist: [{vehicle: {mass_kg: 1, coupler: {slack_m: 0}}}]\ncommands: parts/brakes.csv\n",
           {"commands[1].reduction_kpa=80"});
  ASSERT_EQ(scenario.commands.size(), 2U);
  EXPECT_EQ(scenario.commands[0].time_s, 0.0);
  EXPECT_EQ(scenario.commands[0].reduction_kpa, 50.0);
  EXPECT_EQ(scenario.commands[1].time_s, 12.5);
  EXPECT_EQ(scenario.commands[1].reduction_kpa, 80.0);
}

TEST_F(CsvTest, PartsInATableAreFoundFromTheTable) {
  Put("mine/vehicles/tank.yaml", "mass_kg: 7\ncoupler: {slack_m: 0.01}\n");
  Put("mine/consist.csv", "vehicle,count\ntank,3\n\"tank\",\n");
  const Scenario scenario = Read("consist: mine/consist.csv\n");
  ASSERT_EQ(scenario.consist.size(), 2U);
  EXPECT_EQ(scenario.consist[0].count, 3);
  EXPECT_EQ(scenario.consist[1].count, 1);
  EXPECT_EQ(scenario.consist[1].vehicle.mass_kg, 7.0);
}

TEST_F(CsvTest, ErrorsOfAListNameLineAndColumn) {
  const std::string consist = "consist: [{vehicle: {mass_kg: 1, coupler: {slack_m: 0}}}]\n";
  Put("c.csv", "time_s,reduction_kp\n0,50\nsoon,60\n-1,70\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"),
            "c.csv:1: commands[0].reduction_kp is not a known key; did you mean reduction_kpa?\n"
            "c.csv:3: commands[1].time_s must be a number, got 'soon'\n"
            "c.csv:4: commands[2].time_s must be >= 0, got -1");
  Put("c.csv", "reduction_kpa\n50\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"), "c.csv:2: commands[0].time_s is missing (must be >= 0)");
  EXPECT_EQ(ErrorsOf(consist + "commands: nowhere.csv\n"),
            "a.yaml:2: commands names the file 'nowhere.csv', but there is no nowhere.csv");
  Put("c.csv", "time_s\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"), "c.csv:1: names columns, but no row follows");
}

}  // namespace
}  // namespace strict_config
