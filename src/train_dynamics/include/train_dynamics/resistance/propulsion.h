#pragma once

#include <optional>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Resistance of a vehicle in newtons per kilonewton of its weight:  a + b k + c k^2,  k = |speed| in km/h.
///
/// Every law of propulsion resistance is brought to this form for a vehicle of given mass and number of axles
/// (CoefficientsOf), so that the time step knows only one.
struct ResistanceCoefficients {
  double constant_n_per_kn = 0.0;        ///< a
  double linear_n_per_kn_kmh = 0.0;      ///< b
  double quadratic_n_per_kn_kmh2 = 0.0;  ///< c, aerodynamic
};

enum class PropulsionResistanceLaw {
  kAbc,            ///< the three coefficients as they are
  kCn,             ///< Canadian National, AREMA Manual ch. 16
  kModifiedDavis,  ///< as in Cole, Handbook of Railway Vehicle Dynamics ch. 9
  kSzd,            ///< Russian traction rules, four-axle wagons on roller bearings
  kStrahl
};

/// r = 1.5 + 18 n / W + 0.03 V + C A V^2 / (10000 W)  in pounds per short ton; n axles, W short tons, V mph. [S]
/// (AREMA Manual ch. 16, as in the manual of the Train Performance Simulator)
struct CnResistanceParams {
  double frontal_area_ft2 = kRequired;
  double drag_coefficient = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("frontal_area_ft2", frontal_area_ft2, kPositive, "A, frontal area");
    v.Number("drag_coefficient", drag_coefficient, kNonNegative,
             "C, of a vehicle within a train: 4.2 a loaded gondola, 24 a leading locomotive");
  }
};

/// r = K_a (2.943 + 89.2 / m_a + 0.0306 k + 1.718 K_ad k^2 / (m_a n))  in newtons per tonne; m_a tonnes per axle. [M]
struct ModifiedDavisParams {
  double adjustment_factor = 0.85;
  double drag_factor = 0.07;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("adjustment_factor", adjustment_factor, kPositive, "K_a, factor on the whole resistance");
    v.Number("drag_factor", drag_factor, kNonNegative, "K_ad, factor on the term with the speed squared");
  }
};

/// r = f0 + f2 ((k + w) / 100)^2  in newtons per kilonewton. [S] (Wende, Fahrdynamik des Schienenverkehrs, 2003, p.
/// 153)
struct StrahlParams {
  double constant_n_per_kn = kRequired;
  double quadratic_n_per_kn = kRequired;
  double head_wind_kmh = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("constant_n_per_kn", constant_n_per_kn, kNonNegative, "f0: 1.4 of ore wagons, 2.2 of a V 90");
    v.Number("quadratic_n_per_kn", quadratic_n_per_kn, kNonNegative, "f2 at 100 km/h: 3.9 of ore wagons, 10 of a V 90");
    v.Number("head_wind_kmh", head_wind_kmh, kNonNegative, "w, added to the speed: 15 for locomotives");
  }
};

enum class BreakawayLaw {
  kRollerBearings,  ///< 28 / (q0 + 7) [M]
  kPlainBearings,   ///< 142 / (q0 + 7) [M]
  kConstant
};

/// Least resistance of a vehicle's bearings while it starts, in newtons per kilonewton; q0 tonnes per axle:
///
///   roller_bearings 28 / (q0 + 7),  plain_bearings 142 / (q0 + 7)   (Russian traction rules [M]),  constant: as given.
///
/// It holds from standstill until the vehicle has moved `distance_m` [A], in place of a + b k where that is less. Left
/// out: the time at rest, and temperature.
struct BreakawayParams {
  BreakawayLaw law = BreakawayLaw::kRollerBearings;
  double constant_n_per_kn = kRequired;
  double distance_m = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law,
             {{"roller_bearings", BreakawayLaw::kRollerBearings},
              {"plain_bearings", BreakawayLaw::kPlainBearings},
              {"constant", BreakawayLaw::kConstant}},
             "roller_bearings: 28 / (q0 + 7) N/kN with q0 tonnes per axle; plain_bearings: 142 / (q0 + 7) [M]");
    if (law == BreakawayLaw::kConstant)
      v.Number("constant_n_per_kn", constant_n_per_kn, kNonNegative, "of the law constant, per weight");
    v.Number("distance_m", distance_m, kPositive, "that the vehicle moves from standstill until it has started");
  }
};

/// The law of a vehicle's propulsion resistance and its parameters. `abc` is the paper's Eq 5.
///
/// `szd` has none: with q0 tonnes per axle, 0.7 + (3 + 0.1 k + 0.0025 k^2) / q0 newtons per kilonewton above 6 t, else
/// 1.0 + 0.044 k + 0.00024 k^2. [S] (maisvendoo/train, after the Russian traction rules)
struct PropulsionResistanceParams {
  double constant_n_per_kn = kRequired;
  double linear_n_per_kn_kmh = kRequired;
  double quadratic_n_per_kn_kmh2 = kRequired;
  PropulsionResistanceLaw law = PropulsionResistanceLaw::kAbc;
  CnResistanceParams cn = {};
  ModifiedDavisParams modified_davis = {};
  StrahlParams strahl = {};
  std::optional<BreakawayParams> breakaway = {};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law,
             {{"abc", PropulsionResistanceLaw::kAbc},
              {"cn", PropulsionResistanceLaw::kCn},
              {"modified_davis", PropulsionResistanceLaw::kModifiedDavis},
              {"szd", PropulsionResistanceLaw::kSzd},
              {"strahl", PropulsionResistanceLaw::kStrahl}},
             "abc: a + b k + c k^2 with k in km/h (paper Eq 5); cn: Canadian National, AREMA Manual ch. 16; "
             "modified_davis; szd: Russian traction rules; strahl");
    if (law == PropulsionResistanceLaw::kAbc) {
      v.Number("constant_n_per_kn", constant_n_per_kn, kNonNegative, "a, per weight");
      v.Number("linear_n_per_kn_kmh", linear_n_per_kn_kmh, kNonNegative, "b, per weight and speed in km/h");
      v.Number("quadratic_n_per_kn_kmh2", quadratic_n_per_kn_kmh2, kNonNegative,
               "c, per weight and speed squared in km/h");
    }
    if (law == PropulsionResistanceLaw::kCn) v.Group("cn", cn, "parameters of the law cn");
    if (law == PropulsionResistanceLaw::kModifiedDavis)
      v.Group("modified_davis", modified_davis, "parameters of the law modified_davis");
    if (law == PropulsionResistanceLaw::kStrahl) v.Group("strahl", strahl, "parameters of the law strahl");
    v.Group("breakaway", breakaway, "resistance of bearings while the vehicle starts; not given: none");
  }
};

/// The law of a vehicle as coefficients of its speed. Weights are m g with g = 9.81 m/s^2.
/// @param mass_kg  of the whole vehicle, > 0
/// @param axles    > 0
ResistanceCoefficients CoefficientsOf(const PropulsionResistanceParams& p, double mass_kg, int axles);

/// Resistance of a vehicle's bearings while it starts [N], >= 0; opposes motion, set-valued at rest. Arguments as
/// above.
double BreakawayResistance(const BreakawayParams& p, double mass_kg, int axles);

/// Resistance that arises at wheels and bearings [N], even in the speed; opposes motion, set-valued at rest.
///
///   R_w = W (a + b v) / 1000,  v in km/h, W the weight [N]   (the first two terms of paper Eq 5)
template <class T>
T RollingResistance(const ResistanceCoefficients& p, double weight_n, T speed) {
  const double weight_kn = 1e-3 * weight_n;
  return weight_kn * (p.constant_n_per_kn + p.linear_n_per_kn_kmh * (3.6 * Abs(speed)));
}

/// Drag of the air [N], even in the speed; opposes motion and vanishes at rest.
///
///   R_a = W c v^2 / 1000,  v in km/h, W the weight [N]   (the third term of paper Eq 5)
template <class T>
T AirDrag(const ResistanceCoefficients& p, double weight_n, T speed) {
  const double weight_kn = 1e-3 * weight_n;
  const T v_kmh = 3.6 * speed;
  return weight_kn * p.quadratic_n_per_kn_kmh2 * (v_kmh * v_kmh);
}

}  // namespace train_dynamics
