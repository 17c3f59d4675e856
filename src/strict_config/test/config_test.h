#pragma once

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

/// What the tests of this package read: a small train in the vocabulary of parameters.h, and their folder.
namespace strict_config {

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
    for (std::size_t at = 0; (at = text.find(prefix, at)) != std::string::npos;) text.erase(at, prefix.size());
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

/// With a few parts in the folder.
class PartsTest : public ConfigTest {
 protected:
  void SetUp() override {
    ConfigTest::SetUp();
    Put("couplers/f_type.yaml", "slack_m: 0.01\npreload_n: 100\nstiffness_n_per_m: [1, 2]\n");
    Put("couplers/g_type.yaml", "base: f_type\nslack_m: 0.02\nstiffness_n_per_m: [3]\n");
    Put("vehicles/wagon.yaml", "name: wagon\nmass_kg: 100000\ncontact: {friction_coefficient: 0.2}\ncoupler: f_type\n");
  }
};

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

}  // namespace strict_config
