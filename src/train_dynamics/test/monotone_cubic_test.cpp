#include "train_dynamics/numeric/monotone_cubic.h"

#include <gtest/gtest.h>

#include <vector>

#include "strict_config/validate.h"

namespace train_dynamics {
namespace {

TEST(MonotoneCubic, DoesNotOvershootAStep) {
  const std::vector<double> x = {0.0, 1.0, 2.0, 3.0, 4.0}, y = {0.0, 0.0, 0.0, 1.0, 1.0};
  double before = 0.0;
  for (double at = 0.0; at <= 4.0; at += 0.01) {
    const double value = MonotoneCubic(x, y, at);
    EXPECT_GE(value, before - 1e-15);
    EXPECT_LE(value, 1.0 + 1e-15);
    before = value;
  }
  // A straight line is reproduced; rounding.
  EXPECT_NEAR(MonotoneCubic({0.0, 1.0, 2.5, 4.0}, {1.0, 3.0, 6.0, 9.0}, 3.1), 7.2, 1e-14);
  EXPECT_THROW(MonotoneCubic(x, y, 4.01), std::domain_error);
}

}  // namespace
}  // namespace train_dynamics
