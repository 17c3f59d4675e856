#include "train_dynamics/train/braked_weight.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace train_dynamics {
namespace {

// Distances of an independent program.
TEST(EtcsStoppingDistance, IsTheConversionModel) {
  EXPECT_NEAR(EtcsStoppingDistance(100.0, 500.0, 100.0, BrakingPosition::kPassenger), 649.0, 0.1);
  EXPECT_NEAR(EtcsStoppingDistance(100.0, 500.0, 120.0, BrakingPosition::kPassenger), 890.9, 0.1);
  EXPECT_NEAR(EtcsStoppingDistance(80.0, 740.0, 100.0, BrakingPosition::kPassenger), 893.2, 0.1);
  EXPECT_NEAR(EtcsStoppingDistance(65.0, 500.0, 80.0, BrakingPosition::kGoods), 732.6, 0.1);
  EXPECT_NEAR(EtcsStoppingDistance(65.0, 740.0, 100.0, BrakingPosition::kGoods), 1094.0, 0.1);
}

TEST(EtcsStoppingDistance, RefusesWhatItIsNotMadeFor) {
  EXPECT_THROW(EtcsStoppingDistance(20.0, 500.0, 100.0, BrakingPosition::kGoods), std::invalid_argument);
  EXPECT_THROW(EtcsStoppingDistance(100.0, 1600.0, 100.0, BrakingPosition::kGoods), std::invalid_argument);
  EXPECT_THROW(EtcsStoppingDistance(100.0, 500.0, 210.0, BrakingPosition::kGoods), std::invalid_argument);
}

TEST(BrakedWeightPercentage, IsUic5441Inverted) {
  EXPECT_NEAR(BrakedWeightPercentage(100.0, 61300.0 / 108.9), 100.0, 1e-9);
  EXPECT_NEAR(BrakedWeightPercentage(120.0, 83634.0 / 108.8), 100.0, 1e-9);
  EXPECT_THROW(BrakedWeightPercentage(80.0, 500.0), std::invalid_argument);
}

}  // namespace
}  // namespace train_dynamics
