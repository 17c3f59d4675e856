#include "strict_config/yaml_tree.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST_F(ConfigTest, FilesThatAreNotYaml) {
  EXPECT_EQ(ErrorsOf(""), "a.yaml:1: must hold a map of keys and values, got nothing");
  EXPECT_EQ(ErrorsOf("# only a comment\n"), "a.yaml:1: must hold a map of keys and values, got nothing");
  EXPECT_EQ(ErrorsOf("just text\n"), "a.yaml:1: must hold a map of keys and values, got 'just text'");
  EXPECT_EQ(ErrorsOf("- 1\n"), "a.yaml:1: must hold a map of keys and values, got a list");
  EXPECT_EQ(ErrorsOf(std::string("a: 1\nb: \0", 9)), "a.yaml:2: is not a text file (it contains a zero byte)");
  EXPECT_EQ(ErrorsOf("\x7f"
                     "ELF\x02"),
            "a.yaml:1: is not a text file (it contains a control character)");
  EXPECT_EQ(ErrorsOf("a: 1\nb: \xff\n"), "a.yaml:2: is not a text file in UTF-8");
  EXPECT_EQ(ErrorsOf("a: \xc0\x80\n"), "a.yaml:1: is not a text file in UTF-8");
  EXPECT_EQ(ErrorsOf("a: \xe2\x82"), "a.yaml:1: is not a text file in UTF-8");
}

TEST_F(ConfigTest, SyntaxErrorsNameTheirLine) {
  EXPECT_EQ(ErrorsOf("record: true\ndetailed: [1, 2\n"), "a.yaml:3: is not valid YAML: end of sequence flow not found");
  EXPECT_EQ(ErrorsOf("patch:\n\tfriction_coefficient: 1\n"), "a.yaml:2: is indented with a tab; indent with spaces");
  EXPECT_EQ(ErrorsOf("record: true\n---\nrecord: false\n"), "a.yaml:3: begins a second document; a file holds one");
  EXPECT_EQ(ErrorsOf("record: !!bool true\n"),
            "a.yaml:1: has the tag 'tag:yaml.org,2002:bool'; tags are not supported");
  EXPECT_EQ(ErrorsOf("[a]: 1\n"), "a.yaml:1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(ErrorsOf("? {a: 1}\n: 1\n"), "a.yaml:1: has a list or map in the place of a key (is a bracket left open?)");
  EXPECT_EQ(ErrorsOf("~: 1\n"), "a.yaml:1: a key must be plain text");
  EXPECT_EQ(ErrorsOf("record: *nowhere\n"), "a.yaml:1: is not valid YAML: the referenced anchor is not defined");
  EXPECT_EQ(ErrorsOf("a: b: c\n"), "a.yaml:1: is not valid YAML: illegal map value");
}

TEST_F(ConfigTest, WindowsFilesAndComments) {
  const Command c =
      Read<Command>("\xEF\xBB\xBF# comment\r\ntime_s: 1 # s\r\n\t# tab before a comment\r\nreduction_kpa: 2\r\n");
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
  EXPECT_EQ(ErrorsOf("a: " + std::string(63, '[') + "1" + std::string(63, ']')),
            "a.yaml:1: a is not a known key; known keys: initial_speed_kmh, record, detailed, consist, commands, "
            "spare_couplers, patch, tail");
  std::string ladder = "a0: &a0 [x]\n";
  for (int i = 1; i < 70; ++i) {
    ladder += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  }
  EXPECT_EQ(ErrorsOf(ladder), "a.yaml:64: is nested deeper than 64 levels");

  EXPECT_EQ(ErrorsOf(std::string((64 << 20) + 1, ' ')), "a.yaml: is larger than 64 MB, the limit for such a file");
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

}  // namespace
}  // namespace strict_config
