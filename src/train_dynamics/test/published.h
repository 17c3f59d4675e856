#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace train_dynamics {

/// Expects a number within a share of a published one, or one of an independent program, and prints both as a row of
/// the table of docs/validation.md.
inline void ExpectPublished(const std::string& what, double obtained, double published, double share) {
  EXPECT_NEAR(obtained / published, 1.0, share) << what << ": " << obtained << " instead of " << published;
  std::printf("| %s | %.5g | %.5g | %+.2f %% | %g %% |\n", what.c_str(), published, obtained,
              100.0 * (obtained / published - 1.0), 100.0 * share);
}

}  // namespace train_dynamics
