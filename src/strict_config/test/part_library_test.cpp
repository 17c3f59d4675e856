#include "strict_config/part_library.h"

#include "config_test.h"

namespace strict_config {
namespace {

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
  Put("else/where/s.yaml", "consist:\n  - vehicle: ../w.yaml\nspare_couplers: [../../couplers/f_type.yaml, f_type]\n");
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
  EXPECT_EQ(Errors(),
            "scenarios/s.yaml:1: tail names 'f_typ', but there is no f_typ.yaml in couplers, share/couplers; "
            "did you mean f_type? (there: f_type, g_type, h_type)\n"
            "scenarios/s.yaml:2: spare_couplers[0] names the file 'x/y.yaml', but there is no scenarios/x/y.yaml\n"
            "scenarios/s.yaml:2: spare_couplers[1] must be a map, a file, or a name from couplers/, got 'a b'\n"
            "scenarios/s.yaml:2: spare_couplers[2] must be a map, a file, or a name from couplers/, got ''");

  Put("scenarios/a.yaml", "mass_kg: 1\nparts: [b]\n");
  LoadFile<Assembly>("scenarios/a.yaml", options);
  EXPECT_EQ(Errors(),
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

}  // namespace
}  // namespace strict_config
