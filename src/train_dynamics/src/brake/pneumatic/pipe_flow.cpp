#include "train_dynamics/brake/pneumatic/pipe_flow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "train_dynamics/numeric/elementary.h"

namespace train_dynamics {
namespace {

constexpr double kPi = 3.141592653589793;

// Natural logarithm for a set-up whose bits no library decides: Halley's steps on e^y = x.
double Log(double x) {
  int halvings = 0;
  for (; x > 2.0; x *= 0.5) ++halvings;
  double y = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double e = Exp(y);
    y += 2.0 * (x - e) / (x + e);
  }
  return y + halvings * 0.6931471805599453;
}

double Power(double x, double exponent) { return Exp(exponent * Log(x)); }

double FrictionLaw(double reynolds) {
  return reynolds <= 4000.0 ? 0.000137 * Power(reynolds, 1.717) : 0.13977 * Power(reynolds, 1.0 - 0.11781);
}

}  // namespace

double NozzleConductance(double diameter_m, double discharge_coefficient, double temperature_k) {
  const double area_m2 = kPi / 4.0 * diameter_m * diameter_m;
  return discharge_coefficient * area_m2 * std::sqrt(2.0 * 1.4 / (0.4 * kGasConstantOfAir * temperature_k));
}

PipeFriction::PipeFriction() {
  const int steps = static_cast<int>((kTo - kFrom) / kStep);
  for (int i = 0; i <= steps + 1; ++i) table_.push_back(FrictionLaw(kFrom + kStep * i));
}

PipeFriction::PipeFriction(double constant_factor) : constant_(constant_factor) {}

PipeGrid::PipeGrid(double diameter, double temperature_k, const std::vector<double>& lengths_m,
                   const std::vector<double>& branch_volume_m3, PipeFriction friction_law)
    : diameter_m(diameter),
      area_m2(kPi / 4.0 * diameter * diameter),
      rt(kGasConstantOfAir * temperature_k),
      cell_length_m(lengths_m),
      friction(std::move(friction_law)) {
  const std::size_t n = lengths_m.size();
  for (std::size_t i = 0; i < n; ++i) {
    volume_m3.push_back(area_m2 * lengths_m[i] + branch_volume_m3[i]);
    rt_over_volume.push_back(rt / volume_m3[i]);
  }
  area_over_length.assign(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i) area_over_length[i] = area_m2 / (0.5 * (lengths_m[i - 1] + lengths_m[i]));
}

double PipeGrid::LongestStep() const {
  return 0.5 * *std::min_element(cell_length_m.begin(), cell_length_m.end()) / std::sqrt(rt);
}

PipeFlow::PipeFlow(const PipeGrid& grid, double pressure)
    : pressure_pa(grid.volume_m3.size(), pressure),
      mass_flow_kgps(grid.volume_m3.size() + 1, 0.0),
      open(grid.volume_m3.size() + 1, 1.0),
      momentum_flux(grid.volume_m3.size(), 0.0) {}

void Advance(const PipeGrid& grid, double dt_s, PipeFlow& flow) {
  const int n = grid.cells();
  double* p = flow.pressure_pa.data();
  double* m = flow.mass_flow_kgps.data();
  const double* open = flow.open.data();
  double* flux = flow.momentum_flux.data();
  const double* a = grid.area_over_length.data();

  const double to_flux = 0.5 * grid.rt / grid.area_m2;
  for (int i = 0; i < n; ++i) {
    const double through = m[i] + m[i + 1];
    flux[i] = to_flux * through * (through > 0.0 ? m[i] : m[i + 1]) / p[i];
  }

  const double to_reynolds = grid.diameter_m / (grid.area_m2 * kViscosityOfAir);
  // f |m| / (2 D rho) = (f Re) viscosity / (2 D^2 rho), rho = (p[i-1] + p[i]) / (2 R T)
  const double to_rate = dt_s * kViscosityOfAir * grid.rt / (grid.diameter_m * grid.diameter_m);
  const double per_area = 1.0 / grid.area_m2;
  for (int i = 1; i < n; ++i) {
    const double push = a[i] * ((p[i] - p[i - 1]) + per_area * (flux[i] - flux[i - 1]));
    const double friction = grid.friction.FactorTimesReynolds(to_reynolds * Abs(m[i])) / (p[i - 1] + p[i]);
    m[i] = open[i] * (m[i] - dt_s * push) / (1.0 + to_rate * friction);
  }

  const double* rt_over_volume = grid.rt_over_volume.data();
  for (int i = 0; i < n; ++i) p[i] += dt_s * rt_over_volume[i] * (m[i] - m[i + 1]);
}

double MassOf(const PipeGrid& grid, const PipeFlow& flow) {
  double pv = 0.0;
  for (int i = 0; i < grid.cells(); ++i) pv += flow.pressure_pa[i] * grid.volume_m3[i];
  return pv / grid.rt;
}

}  // namespace train_dynamics
