#include "strict_config/suggestion.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST(Suggestion, NearestOfTheKnownWords) {
  const std::vector<std::string> known{"friction_coefficient", "wheel_radius_m", "wheelbase_m", "mass_kg",
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

  std::vector<std::string> many;
  for (int i = 0; i < 40; ++i) many.push_back("part" + std::to_string(i));
  const std::string hint = KeyHint("colour", many);
  for (const std::string& word : many) EXPECT_NE(hint.find(word), std::string::npos) << word;
  EXPECT_EQ(KeyHint("colour", many, "column", 2), "; known columns: part0, part1, ...");
}

TEST_F(ConfigTest, UnknownKeysOfAGroup) {
  EXPECT_EQ(ErrorsOf<Vehicle>("mass_kg: 1\ncoupler: {slack_m: 0}\ncontact:\n  frction: 0.1\n"),
            "a.yaml:4: contact.frction is not a known key; did you mean friction_coefficient?");
  EXPECT_EQ(ErrorsOf<Contact>("base_friction: 1\n<<: {a: 1}\n"),
            "a.yaml:1: base_friction is not a known key; known keys: friction_coefficient\n"
            "a.yaml:2: << is not a known key; known keys: friction_coefficient");
}

}  // namespace
}  // namespace strict_config
