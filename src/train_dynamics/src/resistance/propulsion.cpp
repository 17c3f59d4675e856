#include "train_dynamics/resistance/propulsion.h"

namespace train_dynamics {
namespace {

constexpr double kGravity = 9.81;                    // [m/s^2]
constexpr double kNewtonPerPound = 4.4482216152605;  // of force
constexpr double kKgPerShortTon = 907.18474;
constexpr double kKmhPerMph = 1.609344;

ResistanceCoefficients Cn(const CnResistanceParams& p, double mass_kg, int axles) {
  const double short_tons = mass_kg / kKgPerShortTon;
  const double unit = 1e3 * kNewtonPerPound / (kKgPerShortTon * kGravity);  // N/kN per lb/short ton
  return {unit * (1.5 + 18.0 * axles / short_tons), unit * 0.03 / kKmhPerMph,
          unit * p.drag_coefficient * p.frontal_area_ft2 / (1e4 * short_tons * kKmhPerMph * kKmhPerMph)};
}

ResistanceCoefficients ModifiedDavis(const ModifiedDavisParams& p, double mass_kg, int axles) {
  const double axle_t = 1e-3 * mass_kg / axles;
  const double unit = p.adjustment_factor / kGravity;  // N/kN per N/t, with K_a
  return {unit * (2.943 + 89.2 / axle_t), unit * 0.0306, unit * 1.718 * p.drag_factor / (axle_t * axles)};
}

ResistanceCoefficients Szd(double mass_kg, int axles) {
  const double axle_t = 1e-3 * mass_kg / axles;
  if (axle_t > 6.0) return {0.7 + 3.0 / axle_t, 0.1 / axle_t, 0.0025 / axle_t};
  return {1.0, 0.044, 0.00024};
}

ResistanceCoefficients Strahl(const StrahlParams& p) {
  const double per_kmh2 = 1e-4 * p.quadratic_n_per_kn, wind = p.head_wind_kmh;
  return {p.constant_n_per_kn + per_kmh2 * wind * wind, 2.0 * per_kmh2 * wind, per_kmh2};
}

}  // namespace

ResistanceCoefficients CoefficientsOf(const PropulsionResistanceParams& p, double mass_kg, int axles) {
  switch (p.law) {
    case PropulsionResistanceLaw::kCn:
      return Cn(p.cn, mass_kg, axles);
    case PropulsionResistanceLaw::kModifiedDavis:
      return ModifiedDavis(p.modified_davis, mass_kg, axles);
    case PropulsionResistanceLaw::kSzd:
      return Szd(mass_kg, axles);
    case PropulsionResistanceLaw::kStrahl:
      return Strahl(p.strahl);
    default:
      return {p.constant_n_per_kn, p.linear_n_per_kn_kmh, p.quadratic_n_per_kn_kmh2};
  }
}

double BreakawayResistance(const BreakawayParams& p, double mass_kg, int axles) {
  const double weight_kn = 1e-3 * kGravity * mass_kg, axle_t = 1e-3 * mass_kg / axles;
  switch (p.law) {
    case BreakawayLaw::kRollerBearings:
      return weight_kn * 28.0 / (axle_t + 7.0);
    case BreakawayLaw::kPlainBearings:
      return weight_kn * 142.0 / (axle_t + 7.0);
    default:
      return weight_kn * p.constant_n_per_kn;
  }
}

}  // namespace train_dynamics
