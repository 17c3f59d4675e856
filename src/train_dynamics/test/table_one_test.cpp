#include <gtest/gtest.h>

#include <string>

#include "simulate.h"

/// The paper's Table 1: speeds of the train at the end of its three scenarios, by conventional train
/// dynamics.
namespace train_dynamics {
namespace {

double DissipatedBy(const EnergyLedger& ledger, const std::string& element) {
  for (const auto& [name, energy] : ledger.dissipated_j) {
    if (name == element) return energy;
  }
  ADD_FAILURE() << "no account named " << element;
  return 0.0;
}

struct Row {
  const char* scenario;
  double without_inertia_kmh;  // the row that the brake was calibrated on
  double with_inertia_kmh;     // the paper's
  double tolerance_kmh;        // a bias that is known and documented
};

class TableOne : public testing::TestWithParam<Row> {};

TEST_P(TableOne, FinalSpeedsOfTheLtdTrains) {
  const Outcome without = Simulate(GetParam().scenario, {"model=ltd-no-inertia"});
  EXPECT_NEAR(without.mean_speed_kmh, GetParam().without_inertia_kmh,
              0.01);  // a unit of the table's last digit
  ExpectLedgerCloses(without, "ltd-no-inertia");
  const Outcome with = Simulate(GetParam().scenario, {"model=ltd"});
  EXPECT_NEAR(with.mean_speed_kmh, GetParam().with_inertia_kmh, GetParam().tolerance_kmh);
  ExpectLedgerCloses(with, "ltd");
  EXPECT_GT(DissipatedBy(with.ledger, "draft_gears"), 0.0);
  EXPECT_GT(DissipatedBy(with.ledger, "brake_shoes"), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Paper, TableOne,
                         testing::Values(Row{"emergency", 3.97, 9.86, 0.10},
                                         Row{"full_service", 1.05, 7.20, 0.10},
                                         Row{"minimum", 77.29, 77.45, 0.02}),
                         [](const auto& row) { return std::string(row.param.scenario); });

}  // namespace
}  // namespace train_dynamics
