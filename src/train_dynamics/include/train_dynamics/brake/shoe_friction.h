#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/numeric/linear_table.h"
#include "train_dynamics/numeric/logarithm.h"
#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Laws of the friction between brake shoe and tread; k = |speed| in km/h, K = force of one shoe in tonnes-force
/// (9.81 kN).
enum class ShoeFrictionLaw {
  kEq3,          ///< mu_0 (k + V) / (2 k + V): paper Eq 3
  kComposition,  ///< 0.44 (K + 20) / (4 K + 20) (k + 150) / (2 k + 150) [M] (Russian traction rules)
  kCastIron,     ///< 0.6 (16 K + 100) / (80 K + 100) (k + 100) / (5 k + 100) [M] (Karwatzki; the same rules)
  kTos,          ///< 0.64 / (V^0.15 + 0.1 / V) - fade, V = max(1, |speed| in mph) [S] (Low & Garg 1977, AAR R-269)
  kTable
};

/// Friction over speed at one shoe force.
struct ShoeFrictionCurveParams {
  double shoe_load_kn = kRequired;
  std::vector<double> friction_coefficient;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("shoe_load_kn", shoe_load_kn, kPositive, "force of one shoe of this curve");
    v.Numbers("friction_coefficient", friction_coefficient, kNonNegative, "friction at each speed of the table");
  }
};

/// Friction over speed and shoe force, linear in both between points; beyond the first and the last, their values.
struct ShoeFrictionTableParams {
  std::vector<double> speed_kmh;
  std::vector<ShoeFrictionCurveParams> curves;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("speed_kmh", speed_kmh, kNonNegative, "speeds of the table, ascending");
    v.List("curves", curves,
           "friction over speed, one curve for each shoe force, by ascending force; linear between, beyond "
           "the last ones constant");
    v.Check(!speed_kmh.empty(), "speed_kmh", "must list the speeds of the table");
    v.Check(IsAscending(speed_kmh), "speed_kmh", "must ascend");
    v.Check(!curves.empty(), "curves", "must list at least one curve");
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const std::string key = "curves[" + std::to_string(i) + "].";
      v.Check(curves[i].friction_coefficient.size() == speed_kmh.size(), key + "friction_coefficient",
              "must have as many values as speed_kmh", {"speed_kmh", "curves"});
      v.Check(i == 0 || curves[i].shoe_load_kn > curves[i - 1].shoe_load_kn, key + "shoe_load_kn",
              "must be greater than that of the curve before", {"curves"});
    }
  }
};

/// Brake shoes with ice on them: their friction has the factor  min(1, f + (1 - f) E / E_w),  E the energy that the
/// vehicle's shoes have absorbed since the start of the run, per wheel. [A] Left out: renewed icing; differences
/// between wheels.
struct IcyShoesParams {
  double initial_factor = 0.7;
  double energy_per_wheel_j = 2e6;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("initial_factor", initial_factor, Range{0.0, 1.0, true, false},
             "f, factor on the friction of shoes that have not braked yet [A]");
    v.Number("energy_per_wheel_j", energy_per_wheel_j, kPositive,
             "E_w, energy of the shoes of one wheel after which the factor is 1 [A]");
  }
};

/// The factor on the friction of icy shoes [-]. @param energy_j  E of one wheel, >= 0
template <class T>
T IcyFactor(const IcyShoesParams& p, T energy_j) {
  return Min(T(1.0), p.initial_factor + ((1.0 - p.initial_factor) / p.energy_per_wheel_j) * energy_j);
}

/// Coefficient of friction between brake shoe and wheel tread.
struct ShoeFrictionParams {
  double standstill_friction_coefficient = kRequired;
  double reference_speed_kmh = kRequired;
  ShoeFrictionLaw law = ShoeFrictionLaw::kEq3;
  double shoe_temperature_c = 20.0;
  ShoeFrictionTableParams table;
  double wet_factor = 1.0;
  std::optional<IcyShoesParams> icy = {};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law,
             {{"eq3", ShoeFrictionLaw::kEq3},
              {"composition", ShoeFrictionLaw::kComposition},
              {"cast_iron", ShoeFrictionLaw::kCastIron},
              {"tos", ShoeFrictionLaw::kTos},
              {"table", ShoeFrictionLaw::kTable}},
             "eq3: mu_0 (k + V) / (2 k + V) (paper Eq 3); composition, cast_iron: Russian traction rules "
             "[M]; tos: AAR R-269 [S]; table");
    if (law == ShoeFrictionLaw::kEq3) {
      v.Number("standstill_friction_coefficient", standstill_friction_coefficient, kPositive, "mu_0, at standstill");
      v.Number("reference_speed_kmh", reference_speed_kmh, kPositive, "V");
    }
    if (law == ShoeFrictionLaw::kTos)
      v.Number("shoe_temperature_c", shoe_temperature_c, Range{-60.0, 600.0},
               "temperature of the shoes; constant: shoes do not warm up");
    if (law == ShoeFrictionLaw::kTable) v.Group("table", table, "measured friction over speed and shoe force");
    v.Number("wet_factor", wet_factor, Range{0.0, 1.0, true, false},
             "factor on the friction of every law: 1 dry; wet composition shoes 0.8 [A]");
    v.Group("icy", icy, "shoes with ice on them, which brake less until it is gone; not given: none");
  }
};

/// Shoe friction [-] at a speed [m/s], even in it (paper Eq 3):
///
///   mu_b = mu_0 (v + V) / (2 v + V),  v in km/h;  from mu_0 at rest down to mu_0 / 2
template <class T>
T ShoeFriction(const ShoeFrictionParams& p, T speed) {
  const T v_kmh = 3.6 * Abs(speed);
  return p.standstill_friction_coefficient * (v_kmh + p.reference_speed_kmh) / (2.0 * v_kmh + p.reference_speed_kmh);
}

/// Fade of a hot shoe by the law `tos` [-], T in degrees Fahrenheit:  0 up to 200, 2.5e-6 (T - 200)^2 up to 420,
/// 0.00816 sqrt(T - 200) above.
template <class T>
T TosFade(T temperature_c) {
  const T above_f = Max(T(0.0), 1.8 * temperature_c + 32.0 - 200.0);
  return Select(above_f <= 220.0, 2.5e-6 * above_f * above_f, 0.00816 * Sqrt(above_f));
}

/// Looks up friction coefficients for so many speeds [km/h] and shoe loads [kN].
void LookUpShoeFriction(const ShoeFrictionTableParams& table, int count, const double* speed_kmh,
                        const double* shoe_load_kn, double* friction_coefficient);

/// Shoe friction [-] by any of the laws, even in the speed, >= 0.
/// @param speed        of the tread, or of the vehicle [m/s]
/// @param shoe_load_n  normal force of one shoe [N], >= 0
template <class T>
T ShoeFrictionByLaw(const ShoeFrictionParams& p, T speed, T shoe_load_n) {
  const T k = 3.6 * Abs(speed);
  T mu(0.0);
  if (p.law == ShoeFrictionLaw::kEq3) {
    mu = ShoeFriction(p, speed);
  } else if (p.law == ShoeFrictionLaw::kComposition) {
    const T load_tf = shoe_load_n / 9810.0;
    mu = 0.44 * (load_tf + 20.0) / (4.0 * load_tf + 20.0) * ((k + 150.0) / (2.0 * k + 150.0));
  } else if (p.law == ShoeFrictionLaw::kCastIron) {
    const T load_tf = shoe_load_n / 9810.0;
    mu = 0.6 * (16.0 * load_tf + 100.0) / (80.0 * load_tf + 100.0) * ((k + 100.0) / (5.0 * k + 100.0));
  } else if (p.law == ShoeFrictionLaw::kTos) {
    const T mph = Max(T(1.0), k / 1.609344);
    mu = Max(T(0.0), 0.64 / (Exp(0.15 * Log(mph)) + 0.1 / mph) - TosFade(T(p.shoe_temperature_c)));
  } else {
    constexpr int kLanes = kLanesOf<T>;
    double speed_kmh[kLanes], load_kn[kLanes], friction[kLanes];
    Store(k, speed_kmh);
    Store(1e-3 * shoe_load_n, load_kn);
    LookUpShoeFriction(p.table, kLanes, speed_kmh, load_kn, friction);
    mu = Load<T>(friction);
  }
  return p.wet_factor * mu;
}

/// The body that carries the brake shoes, and takes the reactions of the torques on the wheelsets (2D model).
enum class BrakeReaction {
  kFrame,    ///< shoes on the bogie frame: it gets the opposite of the torque of each of its wheelsets
  kCarbody,  ///< shoes on the carbody; bearings, traction and dynamic brake react on the frame
  kNone      ///< the paper's simplification: all torques act on the wheelsets as if from outside
};

/// The speed of which the friction between shoe and tread is a function (2D model).
enum class FrictionSpeed {
  kTread,   ///< |omega r| of each wheelset
  kVehicle  ///< that of the carbody
};

/// How the shoes' normal load follows from the cylinder pressure.
enum class ShoeLoadForm {
  kPerPressure,     ///< C p
  kCylinder,        ///< max(0, p A - F_spring) i eta
  kNetBrakingRatio  ///< C p, with C such that the load is a share of the vehicle's weight at a pressure
};

/// Brake cylinder and levers. All of the vehicle's cylinders are one.
struct BrakeCylinderParams {
  double piston_area_m2 = kRequired;
  double return_spring_n = 0.0;
  double leverage_ratio = kRequired;
  std::optional<double> efficiency;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("piston_area_m2", piston_area_m2, kPositive, "A, area of all pistons of the vehicle together");
    v.Number("return_spring_n", return_spring_n, kNonNegative, "F_spring, force that the pressure must overcome first");
    v.Number("leverage_ratio", leverage_ratio, kPositive, "i, force of all shoes over that of the piston");
    v.Number("efficiency", efficiency, Range{0.0, 1.0, true, false},
             "eta of the rigging; not given: sqrt(ln(p - 6)) / 3.2, p in psi, that of 10 psi below (TOS) [S]");
  }
};

/// Load of all shoes over the vehicle's weight at a cylinder pressure: 0.11 of loaded, 0.25 of empty wagons at full
/// service (AAR) [S].
struct NetBrakingRatioParams {
  double ratio = kRequired;
  double at_pressure_kpa = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("ratio", ratio, Range{0.0, 2.0, false, false},
             "load of all shoes over the vehicle's weight: 0.11 of loaded, 0.25 of empty wagons at full "
             "service (AAR) [S]");
    v.Number("at_pressure_kpa", at_pressure_kpa, kPositive, "cylinder pressure at which it is reached");
  }
};

enum class LoadSensingKind {
  kProportional,  ///< clamp(m / full mass, least share, 1)
  kTwoStep        ///< the empty share below the change-over mass, else 1
};

/// Load-dependent braking: weaker if the vehicle is not full.
struct LoadSensingParams {
  LoadSensingKind kind = LoadSensingKind::kProportional;
  double full_mass_kg = kRequired;
  double least_share = 0.3;
  double changeover_mass_kg = kRequired;
  double empty_share = 0.5;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("kind", kind, {{"proportional", LoadSensingKind::kProportional}, {"two_step", LoadSensingKind::kTwoStep}},
             "proportional: share = mass / full_mass_kg; two_step: empty_share below the change-over mass, "
             "else 1");
    if (kind == LoadSensingKind::kProportional) {
      v.Number("full_mass_kg", full_mass_kg, kPositive,
               "mass of the vehicle for which the full load of the shoes is meant");
      v.Number("least_share", least_share, kFraction, "share of the full load of the shoes that is always there [A]");
    } else {
      v.Number("changeover_mass_kg", changeover_mass_kg, kPositive,
               "mass of the vehicle below which empty_share holds");
      v.Number("empty_share", empty_share, kFraction,
               "share of the full load of the shoes when empty: 0.35 to 0.60 [S]");
    }
  }

  /// Shoe load of a vehicle of this mass as a share of the full one [-].
  double Share(double mass_kg) const {
    if (kind == LoadSensingKind::kTwoStep) return mass_kg < changeover_mass_kg ? empty_share : 1.0;
    return Clamp(mass_kg / full_mass_kg, least_share, 1.0);
  }
};

/// Brake rigging of a vehicle: from cylinder pressure to the shoes' tangential force.
struct BrakeRiggingParams {
  double shoe_load_per_pressure_n_per_pa = kRequired;
  ShoeFrictionParams shoe_friction;
  BrakeReaction reaction = BrakeReaction::kFrame;
  FrictionSpeed friction_speed = FrictionSpeed::kTread;
  ShoeLoadForm shoe_load = ShoeLoadForm::kPerPressure;
  BrakeCylinderParams cylinder;
  NetBrakingRatioParams net_braking_ratio;
  int shoes = 8;
  std::optional<LoadSensingParams> load_sensing;
  bool cut_out = false;
  double hand_brake_ratio = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("shoe_load", shoe_load,
             {{"per_pressure", ShoeLoadForm::kPerPressure},
              {"cylinder", ShoeLoadForm::kCylinder},
              {"net_braking_ratio", ShoeLoadForm::kNetBrakingRatio}},
             "how the shoes' load follows from the pressure: per_pressure: C p; cylinder: max(0, p A - "
             "F_spring) i eta; net_braking_ratio: a share of the weight");
    if (shoe_load == ShoeLoadForm::kPerPressure)
      v.Number("shoe_load_per_pressure_n_per_pa", shoe_load_per_pressure_n_per_pa, kNonNegative,
               "C, load of all shoes of the vehicle per cylinder pressure");
    if (shoe_load == ShoeLoadForm::kCylinder)
      v.Group("cylinder", cylinder, "brake cylinder and levers; all of the vehicle's cylinders are one");
    if (shoe_load == ShoeLoadForm::kNetBrakingRatio)
      v.Group("net_braking_ratio", net_braking_ratio,
              "load of all shoes over the vehicle's weight at a cylinder pressure");
    v.Integer("shoes", shoes, Range{1, 48, false, false}, "number of shoes of the vehicle, which share the load");
    v.Group("load_sensing", load_sensing, "makes the brake weaker where the vehicle is not full");
    v.Check(!load_sensing || shoe_load != ShoeLoadForm::kNetBrakingRatio, "load_sensing",
            "must not be given with shoe_load net_braking_ratio, which is that of the vehicle as it is loaded",
            {"shoe_load"});
    v.Flag("cut_out", cut_out, "the vehicle's air brake does not act");
    v.Number("hand_brake_ratio", hand_brake_ratio, Range{0.0, 0.3, false, false},
             "friction force of the hand brake over the weight; 0: released; 0.02 to 0.1 applied");
    v.Group("shoe_friction", shoe_friction, "friction between shoe and tread");
    v.Choice("reaction", reaction,
             {{"frame", BrakeReaction::kFrame}, {"carbody", BrakeReaction::kCarbody}, {"none", BrakeReaction::kNone}},
             "what holds the shoes: frame: each wheelset's bogie frame; carbody; none: the reaction is left "
             "out (as in the paper)");
    v.Choice("friction_speed", friction_speed, {{"tread", FrictionSpeed::kTread}, {"vehicle", FrictionSpeed::kVehicle}},
             "speed in the law of friction: tread: that of each wheelset's tread; vehicle: that of the carbody");
  }
};

/// Efficiency of a brake rigging [-] after the Train Operations Simulator: sqrt(ln(p - 6)) / 3.2, p >= 10 in psi.
template <class T>
T TosRiggingEfficiency(T pressure_pa) {
  const T psi = Max(T(10.0), pressure_pa / 6894.757293168);
  return Sqrt(Log(psi - 6.0)) / 3.2;
}

/// Constants of the rigging of a vehicle of given weight.
struct BrakeRigging {
  BrakeRigging(const BrakeRiggingParams& p, double mass_kg, double weight_n)
      : params(p),
        load_share(p.cut_out        ? 0.0
                   : p.load_sensing ? p.load_sensing->Share(mass_kg)
                                    : 1.0),
        load_per_pressure_n_per_pa(p.shoe_load_per_pressure_n_per_pa),
        efficiency(p.cylinder.efficiency.value_or(0.0)),
        hand_brake_n(p.hand_brake_ratio * weight_n),
        is_plain(p.shoe_load != ShoeLoadForm::kCylinder && p.shoe_friction.law == ShoeFrictionLaw::kEq3 &&
                 p.shoe_friction.wet_factor == 1.0 && !p.shoe_friction.icy && p.hand_brake_ratio == 0.0) {
    if (p.shoe_load == ShoeLoadForm::kNetBrakingRatio) {
      load_per_pressure_n_per_pa = p.net_braking_ratio.ratio * weight_n / (1e3 * p.net_braking_ratio.at_pressure_kpa);
    }
    load_per_pressure_n_per_pa *= load_share;
  }

  BrakeRiggingParams params;
  double load_share;                  ///< by load sensing or cut-out
  double load_per_pressure_n_per_pa;  ///< C, load share included; not of the form kCylinder
  double efficiency;                  ///< of the form kCylinder; 0: TosRiggingEfficiency
  double hand_brake_n;                ///< constant friction force of all shoes
  bool is_plain;                      ///< C p by Eq 3, without hand brake, ice, water
};

/// Normal load of all shoes of a vehicle [N], >= 0.
template <class T>
T ShoeLoad(const BrakeRigging& rigging, T cylinder_pressure_pa) {
  if (rigging.params.shoe_load != ShoeLoadForm::kCylinder) {
    return rigging.load_per_pressure_n_per_pa * cylinder_pressure_pa;
  }
  const BrakeCylinderParams& cylinder = rigging.params.cylinder;
  const T efficiency = rigging.efficiency > 0.0 ? T(rigging.efficiency) : TosRiggingEfficiency(cylinder_pressure_pa);
  return (rigging.load_share * cylinder.leverage_ratio) * efficiency *
         Max(T(0.0), cylinder.piston_area_m2 * cylinder_pressure_pa - cylinder.return_spring_n);
}

/// ShoeForce of a rigging that is not plain. A function of its own, so that the step of all others does not grow.
template <class T>
[[gnu::noinline]] TRAIN_DYNAMICS_FLATTEN T ShoeForceByLaw(const BrakeRigging& rigging, T cylinder_pressure_pa,
                                                          T speed) {
  const T load = ShoeLoad(rigging, cylinder_pressure_pa);
  return load * ShoeFrictionByLaw(rigging.params.shoe_friction, speed, load * (1.0 / rigging.params.shoes)) +
         rigging.hand_brake_n;
}

/// ShoeForce of a plain rigging.
template <class T>
T PlainShoeForce(const BrakeRigging& rigging, T cylinder_pressure_pa, T speed) {
  return rigging.load_per_pressure_n_per_pa * cylinder_pressure_pa * ShoeFriction(rigging.params.shoe_friction, speed);
}

/// Largest tangential force of all shoes of a vehicle [N]: the load times mu_b(v), and that of the hand brake. It
/// opposes the wheels' rotation.
template <class T>
T ShoeForce(const BrakeRigging& rigging, T cylinder_pressure_pa, T speed) {
  return rigging.is_plain ? PlainShoeForce(rigging, cylinder_pressure_pa, speed)
                          : ShoeForceByLaw(rigging, cylinder_pressure_pa, speed);
}

}  // namespace train_dynamics
