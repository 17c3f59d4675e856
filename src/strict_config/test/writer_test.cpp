#include "strict_config/writer.h"

#include "config_test.h"

namespace strict_config {
namespace {

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

}  // namespace
}  // namespace strict_config
