#pragma once

#include "train_dynamics/numeric/scalar.h"

/// Air in pipes, reservoirs and openings of the pneumatic brake. Pressures are absolute [Pa] unless a name says gauge;
/// the temperature is the same everywhere and always (isothermal): p = rho R T.
namespace train_dynamics {

inline constexpr double kAtmospherePa = 101325.0;
inline constexpr double kGasConstantOfAir = 287.05;        ///< R [J/(kg K)]
inline constexpr double kViscosityOfAir = 1.81e-5;         ///< [Pa s]
inline constexpr double kChokedPressureRatio = 0.5282818;  ///< (2/(kappa+1))^(kappa/(kappa-1)), kappa = 1.4

/// psi(r) = sqrt(r^(2/kappa) - r^((kappa+1)/kappa)), kappa = 1.4, of the pressure ratio r = p2/p1 across an ideal
/// nozzle, 0 <= r <= 1. Below the choked ratio it stays at its maximum, 0.2588. Relative error below 1e-9 for 1 - r >
/// 1e-6.
///
/// With s = r^(1/7), psi = s^5 sqrt(1 - s^2). The root is a polynomial in 1 - r (its series, economised), then two
/// steps of Newton on s^7 = r. One sequence of operations on every machine.
inline double NozzleFunction(double pressure_ratio) {
  const double r = Max(kChokedPressureRatio, pressure_ratio);
  const double e = 1.0 - r;
  double s = 1.0 - e * (0.1429 + e * (0.055 + e * 0.075));
  for (int i = 0; i < 2; ++i) {
    const double s2 = s * s, s6 = s2 * s2 * s2;
    s -= (s6 * s - r) / (7.0 * s6);
  }
  const double s2 = s * s;
  return s2 * s2 * s * Sqrt(Max(0.0, 1.0 - s2));
}

/// Conductance of an opening [kg/(s Pa)]: Cd A sqrt(2 kappa / ((kappa - 1) R T)).
double NozzleConductance(double diameter_m, double discharge_coefficient, double temperature_k);

/// Mass flow [kg/s] from p1 to p2 through an opening: conductance p1 psi(p2 / p1); zero unless p1 > p2 > 0.
inline double NozzleFlow(double conductance, double p1_pa, double p2_pa) {
  return p1_pa > p2_pa ? conductance * p1_pa * NozzleFunction(p2_pa / p1_pa) : 0.0;
}

/// p V [J] that passes in dt from (p1, V1) to (p2, V2), at most what makes both pressures equal: an opening between two
/// vessels never overshoots, however long the step. Both pressures are updated. Mass is p V / (R T).
///
/// @param conductance_rt  conductance times R T [m3/s]
/// @return p V that passed, >= 0; nothing passes unless p1 > p2 (a check valve)
inline double PassOneWay(double conductance_rt, double dt_s, double& p1_pa, double v1_m3, double& p2_pa, double v2_m3) {
  if (!(p1_pa > p2_pa)) return 0.0;
  const double equal = (p1_pa - p2_pa) * (v1_m3 * v2_m3 / (v1_m3 + v2_m3));
  const double pv = Min(equal, conductance_rt * dt_s * p1_pa * NozzleFunction(p2_pa / p1_pa));
  p1_pa -= pv / v1_m3;
  p2_pa += pv / v2_m3;
  return pv;
}

/// The same in whichever direction the pressures drive it; positive from 1 to 2.
inline double Pass(double conductance_rt, double dt_s, double& p1_pa, double v1_m3, double& p2_pa, double v2_m3) {
  return p1_pa >= p2_pa ? PassOneWay(conductance_rt, dt_s, p1_pa, v1_m3, p2_pa, v2_m3)
                        : -PassOneWay(conductance_rt, dt_s, p2_pa, v2_m3, p1_pa, v1_m3);
}

/// p V [J] that passes in dt from a vessel to a place of constant pressure (the atmosphere, a main reservoir): at most
/// what equalises the pressures, nothing if the place has the higher one.
inline double PassToPlace(double conductance_rt, double dt_s, double& p_pa, double v_m3, double place_pa) {
  if (!(p_pa > place_pa)) return 0.0;
  const double pv = Min((p_pa - place_pa) * v_m3, conductance_rt * dt_s * p_pa * NozzleFunction(place_pa / p_pa));
  p_pa -= pv / v_m3;
  return pv;
}

/// p V [J] that passes in dt from a place of constant pressure to a vessel; otherwise as above.
inline double PassFromPlace(double conductance_rt, double dt_s, double place_pa, double& p_pa, double v_m3) {
  if (!(place_pa > p_pa)) return 0.0;
  const double pv = Min((place_pa - p_pa) * v_m3, conductance_rt * dt_s * place_pa * NozzleFunction(p_pa / place_pa));
  p_pa += pv / v_m3;
  return pv;
}

}  // namespace train_dynamics
