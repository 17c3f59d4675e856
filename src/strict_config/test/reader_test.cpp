#include "strict_config/reader.h"

#include "config_test.h"

namespace strict_config {
namespace {

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
  EXPECT_EQ(ErrorsOf<Command>("time_s: \"80\"\n"), "a.yaml:1: time_s must be a number without quotes, got '80'");
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
  EXPECT_EQ(ErrorsOf<Stages>("stages: 1e10\n"), "a.yaml:1: stages must be within the range of an integer, got 1e10");
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
  EXPECT_EQ(ErrorsOf("tail: [1]\n"), "a.yaml:1: tail must be a map, a file, or a name from couplers/, got a list");
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\nname: [a]\n"),
            "a.yaml:3: name must be text, got a list");
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\ncontact:\n"),
            "a.yaml:3: contact must be a map, got nothing");
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: 0\nkind: draft_gaer\n"),
            "a.yaml:2: kind must be one of draft_gear, draw_bar, got 'draft_gaer'; did you mean draft_gear?");
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: 0\nkind: 3\n"), "a.yaml:2: kind must be one of draft_gear, draw_bar, got 3");
}

TEST_F(ConfigTest, MissingValuesPointToTheirMap) {
  EXPECT_EQ(ErrorsOf("consist:\n  - count: 1\n    vehicle:\n      name: a\n"),
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
  EXPECT_EQ(ErrorsOf<Coupler>("slack_m: x\n"), "a.yaml:1: slack_m must be a number, got 'x'");
}

struct Controller {
  double period_s = kRequired;
  double gain = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("period_s", period_s, kPositive, "of the test");
    v.Number("gain", gain, kPositive, "of the test");
  }
};

struct Car {
  int seats = kRequiredInteger;
  Controller controller;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Integer("seats", seats, Range{1, 100, false, false}, "of the test");
    v.Part("controller", controller, "controllers", "of the test");
  }
};

struct Tram {
  double dt_s = 0.1;
  int most_seats = 100;
  std::vector<Car> cars;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("dt_s", dt_s, kPositive, "of the test");
    v.Integer("most_seats", most_seats, Range{1, 1000, false, false}, "of the test");
    v.List("cars", cars, "of the test");
    int seats = 0;
    for (std::size_t i = 0; i < cars.size(); ++i) {
      v.Check(cars[i].controller.period_s >= dt_s, "cars[" + std::to_string(i) + "].controller.period_s",
              "must be at least dt_s", {"dt_s"});
      seats += cars[i].seats;
    }
    v.Check(seats <= most_seats, "most_seats", "must be at least the seats of all", {"cars[].seats"});
  }
};

TEST_F(ConfigTest, RulesAreJudgedWhateverElseIsWrong) {
  Put("controllers/slow.yaml", "period_s: 0.01\n");
  // Besides an entry of the same list, a key of the same part, and a part that is not there.
  EXPECT_EQ(ErrorsOf<Tram>("cars:\n"
                           "- {seats: 5, controller: {period_s: 0.01, gain: -1}}\n"
                           "- {seats: 5, controller: quick}\n"
                           "most_seats: 9\n"
                           "speed: 3\n"),
            "a.yaml:2: cars[0].controller.gain must be > 0, got -1\n"
            "a.yaml:2: cars[0].controller.period_s must be at least dt_s (0.1, default), got 0.01\n"
            "a.yaml:3: cars[1].controller names 'quick', but there is no quick.yaml in controllers (there: slow)\n"
            "a.yaml:4: most_seats must be at least the seats of all, got 9\n"
            "a.yaml:5: speed is not a known key; known keys: dt_s, most_seats, cars");
  // Void by what they read: a number of one entry, an entry that cannot be read, a number beside the list.
  EXPECT_EQ(ErrorsOf<Tram>("cars:\n- {seats: 5, controller: slow}\n- {seats: x, controller: slow}\nmost_seats: 2\n"
                           "dt_s: x\n"),
            "a.yaml:3: cars[1].seats must be a number, got 'x'\na.yaml:5: dt_s must be a number, got 'x'");
  EXPECT_EQ(ErrorsOf<Tram>("dt_s: 1e-3\ncars:\n- {seats: 5, controller: slow}\n- 7\nmost_seats: 2\n"),
            "a.yaml:4: cars[1] must be a map, got 7");
}

TEST_F(ConfigTest, ABrokenRuleDoesNotVoidAnother) {
  EXPECT_EQ(ErrorsOf<Tram>("dt_s: 1\ncars:\n- {seats: 5, controller: {period_s: 0.5}}\nmost_seats: 4\n"),
            "a.yaml:3: cars[0].controller.period_s must be at least dt_s (1), got 0.5\n"
            "a.yaml:4: most_seats must be at least the seats of all, got 4");
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
  EXPECT_NE(Errors().find("unfolds, through its references, to more values than are read"), std::string::npos);
  EXPECT_LT(found.size(), 10u);
}

}  // namespace
}  // namespace strict_config
