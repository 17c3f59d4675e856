#include "strict_config/overrides.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST_F(PartsTest, OverridesReachEverywhere) {
  Put("s.yaml", "initial_speed_kmh: x\nconsist: [{vehicle: wagon}, {vehicle: wagon}]\ncommands: [{time_s: 1}]\n");
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
  EXPECT_EQ(ErrorsOf(text, {"tial.slack_m=10"}), "--set tial.slack_m=10: tial is not a known key; did you mean tail?");
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
  for (const char* path : {"=1", ".a=1", "a.=1", "a..b=1", "a[=1", "a[x]=1", "a[]=1", "a]=1", "a b=1", "[0]=1"}) {
    EXPECT_NE(ErrorsOf(text, {path}).find("must be a path, '=' and a value"), std::string::npos) << path;
  }
  EXPECT_EQ(ErrorsOf(text, {"detailed=[1"}),
            "--set detailed=[1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(ErrorsOf(text, {"tail=h_type"}),
            "--set tail=h_type: tail names 'h_type', but there is no h_type.yaml in couplers; did you mean f_type? "
            "(there: f_type, g_type)");
}

TEST_F(PartsTest, OverridesAfterOtherErrorsAreNotBlamed) {
  EXPECT_EQ(ErrorsOf("tail: none.yaml\n", {"tail.slack_m=1"}),
            "a.yaml:1: tail names the file 'none.yaml', but there is no none.yaml");
}

}  // namespace
}  // namespace strict_config
