#include "strict_config/describer.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace strict_config {
namespace {

enum class Law { kOne, kTwo };

struct Wheel {
  double radius_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("radius_m", radius_m, kPositive, "r");
  }
};

struct Row {
  static constexpr const char* kTableKey = "rows";
  std::vector<Wheel> rows;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.List("rows", rows, "wheels");
  }
};

struct Cart {
  std::string name = "cart";
  Law law = Law::kOne;
  double stiffness_n_per_m = kRequired, damping_ns_per_m = 2.0;
  std::optional<double> mass_kg;
  int axles = 1;
  bool braked = false;
  double brake_n = 5.0;
  double middle_m = 0.0;
  Wheel wheel;
  std::optional<Wheel> spare;
  Row row;
  std::vector<Wheel> more{Wheel{}};
  std::vector<double> shares{0.5, 1.0};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "what it is called");
    v.Choice("law", law, {{"one", Law::kOne}, {"two", Law::kTwo}}, "which law");
    if (law == Law::kOne) v.Number("stiffness_n_per_m", stiffness_n_per_m, kPositive, "k");
    if (law == Law::kTwo) v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative, "c");
    v.Number("mass_kg", mass_kg, kPositive, "m");
    if (!mass_kg) v.Group("wheel", wheel, "one wheel");
    v.Integer("axles", axles, Range{1, 3, false, false}, "number of axles");
    if (axles > 1) v.Number("middle_m", middle_m, kFinite, "place of the middle one");
    v.Flag("braked", braked, "whether it has a brake");
    if (braked) v.Number("brake_n", brake_n, kPositive, "its force");
    v.Group("spare", spare, "a spare wheel");
    v.Part("row", row, "rows", "a row of wheels");
    v.List("more", more, "more wheels");
    v.Numbers("shares", shares, kFraction, "shares");
    v.Check(false, "name", "is always wrong");
  }
};

const KeyDescription& Key(const std::vector<KeyDescription>& keys, const std::string& key) {
  for (const KeyDescription& described : keys) {
    if (described.key == key) return described;
  }
  throw std::invalid_argument("no key " + key);
}

std::string Conditions(const std::vector<KeyCondition>& conditions) {
  std::string text;
  for (const KeyCondition& condition : conditions) text += (text.empty() ? "" : ", ") + condition.Text();
  return text;
}

TEST(Describer, FindsTheKeysOfAllAlternativesInTheirOrder) {
  std::vector<std::string> keys;
  for (const KeyDescription& described : DescribeKeys<Cart>()) keys.push_back(described.key);
  EXPECT_EQ(keys,
            (std::vector<std::string>{"name", "law", "stiffness_n_per_m", "damping_ns_per_m", "mass_kg", "wheel",
                                      "axles", "middle_m", "braked", "brake_n", "spare", "row", "more", "shares"}));
}

TEST(Describer, TellsWithWhichOthersAKeyIsKnown) {
  const std::vector<KeyDescription> keys = DescribeKeys<Cart>();
  const auto known = [&keys](const char* key) { return Conditions(Key(keys, key).known_with); };
  EXPECT_EQ(known("name"), "");
  EXPECT_EQ(known("stiffness_n_per_m"), "law one");
  EXPECT_EQ(known("damping_ns_per_m"), "law two");
  EXPECT_EQ(known("wheel"), "mass_kg not given");
  EXPECT_EQ(known("middle_m"), "axles > 1");
  EXPECT_EQ(known("brake_n"), "braked true");
  EXPECT_EQ(known("shares"), "");
}

TEST(Describer, TellsWhatMustBeGivenAndWhatStandsForTheRest) {
  const std::vector<KeyDescription> keys = DescribeKeys<Cart>();
  EXPECT_FALSE(Key(keys, "stiffness_n_per_m").may_be_left_out);
  EXPECT_EQ(Key(keys, "stiffness_n_per_m").default_value, "");
  EXPECT_TRUE(Key(keys, "damping_ns_per_m").may_be_left_out);
  EXPECT_EQ(Key(keys, "damping_ns_per_m").default_value, "2");
  EXPECT_EQ(Key(keys, "law").default_value, "one");
  EXPECT_EQ(Key(keys, "name").default_value, "cart");
  EXPECT_EQ(Key(keys, "shares").default_value, "[0.5, 1]");
  EXPECT_EQ(Key(keys, "more").default_value, "[{}]");
  EXPECT_TRUE(Key(keys, "mass_kg").may_be_left_out);
  EXPECT_FALSE(Key(keys, "wheel").may_be_left_out);  // its radius has no default
  EXPECT_TRUE(Key(keys, "spare").may_be_left_out);
  EXPECT_TRUE(Key(keys, "row").may_be_left_out);
}

TEST(Describer, DescribesMapsAndListsFurtherDown) {
  const std::vector<KeyDescription> keys = DescribeKeys<Cart>();
  for (const char* const key : {"wheel", "spare", "more"}) {
    ASSERT_EQ(Key(keys, key).keys.size(), 1u) << key;
    EXPECT_EQ(Key(keys, key).keys[0].key, "radius_m");
  }
  EXPECT_EQ(Key(keys, "row").keys.at(0).keys.at(0).meaning, "r");
  EXPECT_EQ(Key(keys, "row").folder, "rows");
  EXPECT_TRUE(Key(keys, "row").may_be_table);
  EXPECT_FALSE(Key(keys, "wheel").may_be_table);
}

/// A number that only one of the laws needs.
struct Needy {
  Law law = Law::kOne;
  double speed_mps = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law, {{"one", Law::kOne}, {"two", Law::kTwo}}, "which law");
    if (law == Law::kTwo && speed_mps != speed_mps) speed_mps = 1.0;
    v.Number("speed_mps", speed_mps, kPositive, "v");
  }
};

TEST(Describer, TellsWithWhichOthersAKeyMustBeGiven) {
  const std::vector<KeyDescription> keys = DescribeKeys<Needy>();
  EXPECT_EQ(Conditions(Key(keys, "speed_mps").known_with), "");
  EXPECT_EQ(Conditions(Key(keys, "speed_mps").required_with), "law one");
  EXPECT_TRUE(Key(keys, "speed_mps").may_be_left_out);
  EXPECT_EQ(Key(keys, "speed_mps").default_value, "");
}

/// One key for two structs.
struct Either {
  Law law = Law::kOne;
  std::vector<Wheel> wheels;
  std::vector<Needy> needs;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law, {{"one", Law::kOne}, {"two", Law::kTwo}}, "which law");
    if (law == Law::kOne) v.List("sources", wheels, "wheels");
    if (law == Law::kTwo) v.List("sources", needs, "needs");
  }
};

TEST(Describer, DescribesOneKeyForTwoStructsTwice) {
  const std::vector<KeyDescription> keys = DescribeKeys<Either>();
  ASSERT_EQ(keys.size(), 3u);
  EXPECT_EQ(keys[1].key, "sources");
  EXPECT_EQ(keys[2].key, "sources");
  std::string text;
  for (const KeyDescription& described : {keys[1], keys[2]})
    text += described.meaning + " with " + Conditions(described.known_with) + " " + described.keys.back().key + ";";
  EXPECT_TRUE(text == "wheels with law one radius_m;needs with law two speed_mps;" ||
              text == "needs with law two speed_mps;wheels with law one radius_m;")
      << text;
}

TEST(Describer, TakesDefaultsFromThePrototype) {
  Cart cart;
  cart.law = Law::kTwo;
  cart.stiffness_n_per_m = 3.0;
  const std::vector<KeyDescription> keys = DescribeKeys(cart);
  EXPECT_EQ(Key(keys, "law").default_value, "two");
  EXPECT_EQ(Key(keys, "stiffness_n_per_m").default_value, "3");
  EXPECT_EQ(Conditions(Key(keys, "stiffness_n_per_m").known_with), "law one");
}

}  // namespace
}  // namespace strict_config
