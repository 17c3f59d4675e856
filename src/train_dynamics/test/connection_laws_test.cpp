// What holds for every law of connections, and the tables, buffers and pairs of gears among them.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gear_cycles.h"
#include "paper_vehicle.h"
#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

ConnectionParams Connection(const std::string& name) {
  return LoadPart<ConnectionParams>("couplers/" + name + ".yaml");
}

/// All that the project ships.
std::vector<ConnectionParams> Shipped() {
  std::vector<ConnectionParams> shipped;
  for (const auto& file : std::filesystem::directory_iterator(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/couplers")) {
    shipped.push_back(Connection(file.path().stem().string()));
  }
  return shipped;
}

TEST(ConnectionLaws, NoClosedPathGivesEnergy) {
  std::vector<ConnectionParams> all = Shipped();
  ASSERT_GE(all.size(), 14u);
  all.push_back(Connection("calibrated"));
  all.back().draft_gear.friction = DraftGearFriction::kStickSpring;
  for (const ConnectionParams& params : all) {
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 20; ++trial) {
      const double reach_m = trial % 2 == 0 ? 0.12 : 0.02;
      const auto check = [&](const auto& law) {
        const std::vector<double> path = RandomPath(random, reach_m, 15, 3000);
        // At rest and back at rest nothing is stored but what was there: of buffers what the screw holds.
        auto memory = law.AtRest(0.0);
        const double before = StoredEnergy(law, 0.0, memory);
        for (const double q : path) ConnectionForce(law, q, 0.0, memory);
        const double gained = StoredEnergy(law, 0.0, memory) - before;
        for (const double rate : {0.0, 0.003, 0.3}) {
          // Of steps of up to 80 um the trapezoids err at corners.
          EXPECT_GT(WorkAlong(law, path, rate) - std::min(0.0, gained), -5.0) << params.name << " " << trial;
        }
      };
      std::visit(check, params.Law());
    }
  }
}

TEST(ConnectionLaws, AreOddWhereTheyAreTheSameInBothDirections) {
  for (const ConnectionParams& params : Shipped()) {
    if (params.kind == ConnectionKind::kSideBuffers) continue;
    const auto check = [&](const auto& law) {
      std::mt19937_64 random(2);
      auto pulled = law.AtRest(0.0), pushed = law.AtRest(0.0);
      const std::vector<double> path = RandomPath(random, 0.1, 10, 500);
      for (std::size_t i = 1; i < path.size(); ++i) {
        const double rate = 1e3 * (path[i] - path[i - 1]);
        const double force = ConnectionForce(law, path[i], rate, pulled).force;
        const double mirrored = ConnectionForce(law, -path[i], -rate, pushed).force;
        ASSERT_EQ(force, -mirrored) << params.name;
      }
    };
    std::visit(check, params.Law());
  }
}

TEST(ConnectionLaws, BeginWithoutForceAnywhereInTheirSlack) {
  for (const ConnectionParams& params : Shipped()) {
    const auto check = [&](const auto& law) {
      for (const double side : {-0.5, 0.0, 0.5}) {
        auto memory = law.AtRest(side * law.Slack());
        EXPECT_NEAR(ConnectionForce(law, side * law.Slack(), 0.0, memory).force, 0.0, 1e-6) << params.name;
      }
    };
    std::visit(check, params.Law());
  }
}

// ---- tables

TEST(TableGear, TakesTheEnergyOfItsTables) {
  ConnectionParams pair = Connection("ge_standard_pair");
  pair.table.locked_stiffness_n_per_m = 1e12;  // whatever the stick line gives back is a property of ours
  const TableGear gears(pair.table);
  const double edge = 0.01194;
  std::vector<double> path = {edge};
  MoveTo(path, 0.12548, 20000);
  const double in = WorkAlong(gears, path);
  EXPECT_NEAR(in, 89.91e3, 5.0);
  MoveTo(path, edge, 20000);
  EXPECT_NEAR(in - WorkAlong(gears, path), 22.48e3, 30.0);  // the step at which it turns

  const TableGear cushion(Connection("eocc_100kip_15in").table);
  path = {0.0};
  MoveTo(path, -0.3967, 40000);
  EXPECT_NEAR(WorkAlong(cushion, path), 177.0e3, 50.0);
}

TEST(TableGear, WithoutHysteresisIsASpring) {
  ConnectionParams tps = Connection("tps_coupler");
  tps.table.damping_ns_per_m = 0.0;
  const TableGear coupler(tps.table);
  StickState<double> memory = coupler.AtRest(0.0);
  for (const auto& [in, kip] :
       std::vector<std::pair<double, double>>{{0.75, 200.0}, {3.0, 325.0}, {4.0, 400.0}, {-0.375, -100.0}}) {
    EXPECT_NEAR(ConnectionForce(coupler, 0.0254 * in, 0.0, memory).force, 4448.22 * kip, 2.0);
  }
}

TEST(TableGear, TakesOtherTablesInCompression) {
  ConnectionParams params = Connection("polymer");
  params.table.compression = Connection("eocc_100kip_15in").table.tables;
  params.table.locked_stiffness_n_per_m = 1.2e8;
  const TableGear both(params.table);
  for (const double side : {1.0, -1.0}) {
    ConnectionParams one = side > 0.0 ? Connection("polymer") : Connection("eocc_100kip_15in");
    one.table.slack_m = params.table.slack_m;
    one.table.locked_stiffness_n_per_m = params.table.locked_stiffness_n_per_m;
    one.table.damping_ns_per_m = params.table.damping_ns_per_m;
    one.table.solid_stiffness_n_per_m = params.table.solid_stiffness_n_per_m;
    const TableGear alone(one.table);
    StickState<double> memory = both.AtRest(0.0), expected = alone.AtRest(0.0);
    for (int i = 0; i < 200; ++i) {
      const double q = side * 0.1 * std::abs(std::sin(0.05 * i)), rate = 0.1 * std::cos(0.3 * i);
      EXPECT_EQ(ConnectionForce(both, q, rate, memory).force, ConnectionForce(alone, q, rate, expected).force);
      EXPECT_EQ(StoredEnergy(both, q, memory), StoredEnergy(alone, q, expected));
    }
  }
}

TEST(TableGear, EndOfStickIsWhereTheLineMeetsTheBranch) {
  const TableGear gears(Connection("ge_standard_pair").table);
  for (const double travel : {0.001, 0.02, 0.08, 0.11}) {
    for (const double share : {0.0, 0.3, 1.0}) {
      const double unloading = gears.tension.Unloading(travel);
      const double force = unloading + share * (gears.tension.Loading(travel) - unloading);
      const double end = gears.tension.EndOfStick(travel, force);
      EXPECT_NEAR(gears.tension.Unloading(end), force - 4.96e7 * (travel - end), 1e-6);
      EXPECT_LE(end, travel);
      EXPECT_GE(end, 0.0);
    }
  }
}

std::string ErrorOf(const ConnectionParams& params) {
  try {
    strict_config::Validate(params);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(TableGear, BadTablesAreRefused) {
  const ConnectionParams good = Connection("ge_standard_pair");
  EXPECT_EQ(ErrorOf(good), "");
  const auto with = [&](auto change) {
    ConnectionParams bad = good;
    change(bad.table);
    return ErrorOf(bad);
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(contains(with([](TableGearParams& t) { t.tables.unloading.force_n.back() = 1352261.0; }),
                       "table.unloading.force_n must nowhere be above loading.force_n"));
  // Between their points, too: the unloading crosses a loading that sags.
  EXPECT_TRUE(contains(with([](TableGearParams& t) {
                         t.tables.loading.force_n = {0.0, 120100.0, 130000.0, 1352260.0};
                       }),
                       "table.unloading.force_n must nowhere be above loading.force_n"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) { t.tables.loading.force_n[2] = 1e5; }),
                       "table.loading.force_n must not descend"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) { t.tables.loading.force_n[0] = 10.0; }),
                       "table.loading.force_n must start at 0"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) {
                         t.tables.loading.travel_m = {0.0, 0.1, 0.05, 0.11354};
                       }),
                       "table.loading.travel_m must ascend"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) {
                         t.tables.unloading.travel_m = {0.0};
                         t.tables.unloading.force_n = {0.0};
                       }),
                       "table.unloading.travel_m must list 2 to 32 points"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) { t.tables.unloading.travel_m.back() = 0.1; }),
                       "table.unloading.travel_m must end where loading.travel_m ends"));
  EXPECT_TRUE(contains(with([](TableGearParams& t) { t.locked_stiffness_n_per_m = 1.8e7; }),
                       "table.locked_stiffness_n_per_m must exceed the steepest slope of the tables, 1823"));
}

// ---- two different gears

TEST(UnequalGears, OfTwoEqualOnesAreAPair) {
  const DraftGearParams gear = Connection("mt2").draft_gear;
  const DampedStickGears pair(gear);
  const UnequalGears<FrictionDevice, FrictionDevice> two{gear.slack_m, FrictionDevice(gear), FrictionDevice(gear)};
  EXPECT_NEAR(two.Stiffness(), pair.Stiffness(), 1e-3);
  std::mt19937_64 random(7);
  const std::vector<double> path = RandomPath(random, 0.12, 20, 400);
  auto expected = pair.AtRest(0.0);
  auto memory = two.AtRest(0.0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double rate = 20.0 * (path[i] - path[i - 1]);
    const double force = ConnectionForce(pair, path[i], rate, expected).force;
    ASSERT_NEAR(ConnectionForce(two, path[i], rate, memory).force, force, 1e-9 * 1e9 + 1e-9 * std::abs(force)) << i;
    ASSERT_NEAR(StoredEnergy(two, path[i], memory), StoredEnergy(pair, path[i], expected), 1.0) << i;
  }
}

TEST(UnequalGears, CarryOneForceAndShareTheTravel) {
  const ConnectionLaw law = Connection("mt2_and_polymer").Law();
  const auto& gears = std::get<UnequalGears<FrictionDevice, TableDevice>>(law);
  auto memory = gears.AtRest(0.0);
  std::mt19937_64 random(9);
  for (const double q : RandomPath(random, 0.15, 20, 300)) {
    ConnectionForce(gears, q, 0.0, memory);
    const double total = std::max(0.0, std::abs(q) - 0.005), rest = total - memory.travel_a;
    EXPECT_GE(memory.travel_a, 0.0);
    EXPECT_GE(rest, -1e-15);
    EXPECT_NEAR(memory.force_a + gears.a.Stop(memory.travel_a), memory.force_b + gears.b.Stop(rest), 1e-4);
  }
}

// ---- side buffers

TEST(SideBuffers, UseUpTheirEnergyInAnImpact) {
  struct Category {
    const char* name;
    double energy_j, speed_kmh;
  };
  // Two wagons of 90 t whose four buffers are just used up: v = sqrt(4 * 4 E / m).
  for (const Category& c : {Category{"side_buffers_a", 30e3, 8.314}, Category{"side_buffers_c", 70e3, 12.700}}) {
    ConnectionParams params = Connection(c.name);
    params.side_buffers.pretension_travel_m = 0.0;
    const SideBuffers buffers(params.side_buffers);
    EXPECT_NEAR(std::sqrt(16.0 * c.energy_j / 90e3) * 3.6, c.speed_kmh, 1e-3);
    const Impact impact = Collide(buffers, 90e3, c.speed_kmh / 3.6, 0.0, 1e-5);
    EXPECT_NEAR(0.5 * impact.travel_m, 0.105, 2e-4) << c.name;
    EXPECT_LT(impact.speed_mps, c.speed_kmh / 3.6);
  }
  EXPECT_NEAR(SideBuffers(Connection("side_buffers_b").side_buffers).buffer.loading.Energy(0.105), 50e3, 1.0);
}

TEST(SideBuffers, AreTightAtRestAndPartWhenPulled) {
  const SideBuffers buffers(Connection("side_buffers_a").side_buffers);
  EXPECT_GT(buffers.pretension_n, 10e3);
  auto memory = buffers.AtRest(0.0);
  EXPECT_NEAR(ConnectionForce(buffers, 0.0, 0.0, memory).force, 0.0, 1e-6);
  // Pulled beyond 2 d_0 the buffers are free: the draw gear alone pulls.
  for (int i = 0; i <= 1000; ++i) ConnectionForce(buffers, 0.03 * i / 1000, 0.0, memory);
  EXPECT_EQ(memory.buffer_force, 0.0);
  EXPECT_NEAR(memory.draw_force, buffers.draw_gear.Loading(buffers.draw_travel_m + 0.03), 1e-6);
  // Pushed, the screw is slack: the buffers alone push.
  for (int i = 0; i <= 1000; ++i) ConnectionForce(buffers, 0.03 - 0.1 * i / 1000, 0.0, memory);
  EXPECT_EQ(memory.draw_force, 0.0);
  EXPECT_NEAR(memory.buffer_force, buffers.buffer.Loading(0.01 + 0.035), 1e-6);
}

}  // namespace
}  // namespace train_dynamics
