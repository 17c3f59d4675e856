#include "train_dynamics/contact/kalker.h"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/numeric/monotone_cubic.h"

namespace train_dynamics {
namespace {

// Columns: a/b = 0.1 ... 1.0, then b/a = 0.9 ... 0.1; rows: Poisson ratio 0, 0.25, 0.5.
constexpr int kColumns = 19;
constexpr std::array<std::array<double, kColumns>, 3> kC11 = {{
    {2.51, 2.59, 2.68, 2.78, 2.88, 2.98, 3.09, 3.19, 3.29, 3.40, 3.51, 3.65, 3.82, 4.06, 4.37, 4.84, 5.57, 6.96, 10.7},
    {3.31, 3.37, 3.44, 3.53, 3.62, 3.72, 3.81, 3.91, 4.01, 4.12, 4.22, 4.36, 4.54, 4.78, 5.10, 5.57, 6.34, 7.78, 11.7},
    {4.85, 4.81, 4.80, 4.82, 4.83, 4.91, 4.97, 5.05, 5.12, 5.20, 5.30, 5.42, 5.58, 5.80, 6.11, 6.57, 7.34, 8.82, 12.9},
}};

/// Interpolates one row of the table at its abscissa: a/b up to the circle, 2 - b/a beyond it.
double InterpolateRow(const std::array<double, kColumns>& row, double abscissa) {
  std::vector<double> x(kColumns);
  for (int i = 0; i < kColumns; ++i) x[i] = 0.1 * (i + 1);
  return MonotoneCubic(x, {row.begin(), row.end()}, abscissa);
}

}  // namespace

double KalkerC11(double semi_axis_ratio, double poisson_ratio) {
  if (!(semi_axis_ratio >= 0.1 && semi_axis_ratio <= 10.0)) {
    throw std::domain_error("Kalker's table holds a/b in [0.1, 10], got " + std::to_string(semi_axis_ratio));
  }
  if (!(poisson_ratio >= 0.0 && poisson_ratio <= 0.5)) {
    throw std::domain_error("Kalker's table holds Poisson ratios in [0, 0.5], got " + std::to_string(poisson_ratio));
  }
  const double abscissa = semi_axis_ratio <= 1.0 ? semi_axis_ratio : 2.0 - 1.0 / semi_axis_ratio;
  const double c0 = InterpolateRow(kC11[0], abscissa);
  const double c1 = InterpolateRow(kC11[1], abscissa);
  const double c2 = InterpolateRow(kC11[2], abscissa);
  const double u = poisson_ratio / 0.25;  // nodes 0, 1, 2
  return 0.5 * (u - 1.0) * (u - 2.0) * c0 - u * (u - 2.0) * c1 + 0.5 * u * (u - 1.0) * c2;
}

}  // namespace train_dynamics
