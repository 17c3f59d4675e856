#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "train_dynamics/brake/shoe_friction.h"
#include "train_dynamics/contact/hertz.h"
#include "train_dynamics/contact/normal_contact.h"
#include "train_dynamics/contact/polach.h"
#include "train_dynamics/resistance/curving.h"
#include "train_dynamics/resistance/propulsion.h"
#include "train_dynamics/slide_protection/slide_protection.h"
#include "train_dynamics/spring/linear_spring_damper.h"
#include "train_dynamics/suspension/centre_plate.h"
#include "train_dynamics/suspension/friction_wedge.h"
#include "train_dynamics/suspension/spring_nest.h"
#include "train_dynamics/traction/locomotive.h"

namespace train_dynamics {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// A rigid body in the longitudinal-vertical plane.
struct BodyParams {
  double mass_kg = kRequired;
  double pitch_inertia_kgm2 = kRequired;
  double cg_height_m = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("mass_kg", mass_kg, kPositive, "mass of the body");
    v.Number("pitch_inertia_kgm2", pitch_inertia_kgm2, kPositive, "pitch inertia about its centre of gravity");
    v.Number("cg_height_m", cg_height_m, kPositive, "height of its centre of gravity above rail, at rest without load");
  }
};

/// A wheelset: two wheels and their axle. Its CG is at the height of the wheel radius.
struct WheelsetParams {
  double mass_kg = kRequired;
  double pitch_inertia_kgm2 = kRequired;
  double wheel_radius_m = kRequired;
  bool accept_large_inertia = false;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("mass_kg", mass_kg, kPositive, "mass of the wheelset");
    v.Number("pitch_inertia_kgm2", pitch_inertia_kgm2, kPositive, "J, inertia of its rotation");
    v.Number("wheel_radius_m", wheel_radius_m, kPositive, "r, radius of the wheels");
    v.Flag("accept_large_inertia", accept_large_inertia, "no warning of a J above m r^2");
  }

  /// J / (m r^2) [-]: 1 if all mass were at the tread; no wheelset can have more.
  double InertiaRatio() const { return pitch_inertia_kgm2 / (mass_kg * wheel_radius_m * wheel_radius_m); }
};

/// Contact of one wheel with its rail; two per wheelset.
struct WheelRailParams {
  NormalContactParams normal;
  HertzParams hertz;
  double shear_modulus_pa = kRequired;
  double creepage_regularisation_speed_mps = kRequired;
  AdhesionParams adhesion;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Group("normal", normal, "normal stiffness and damping of one wheel");
    v.Group("hertz", hertz, "elastic constants and lateral radii");
    v.Number("shear_modulus_pa", shear_modulus_pa, kPositive, "G, shear modulus of wheel and rail");
    v.Number("creepage_regularisation_speed_mps", creepage_regularisation_speed_mps, kPositive,
             "v0, speed below which creepage is regularised");
    v.Part("adhesion", adhesion, "adhesion", "adhesion of the rail, where the track has no patch");
  }
};

/// What a vehicle carries when it is full.
struct LoadParams {
  double mass_kg = kRequired;
  std::optional<double> cg_height_m;
  std::optional<double> pitch_inertia_kgm2;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("mass_kg", mass_kg, kPositive, "mass of the full load");
    v.Number("cg_height_m", cg_height_m, kPositive, "height of its centre of gravity above rail (2D model)");
    v.Number("pitch_inertia_kgm2", pitch_inertia_kgm2, kNonNegative,
             "pitch inertia about its own centre of gravity (2D model)");
  }
};

/// A vehicle: one mass, which is all that its LTD model needs, or else the bodies of its 2D model, which make its LTD
/// model as well: a carbody on two bogies of two or three wheelsets each.
struct VehicleParams {
  std::string name;
  double length_m = kRequired;
  std::optional<double> mass_kg;
  int axles = 4;
  double rotating_mass_kg = 0.0;
  std::optional<LoadParams> load;
  std::optional<double> load_fraction;
  BodyParams carbody;
  BodyParams bolster;
  BodyParams bogie_frame;
  WheelsetParams wheelset;
  double wedge_mass_kg = kRequired;
  double half_bogie_spacing_m = kRequired;
  int wheelsets_per_bogie = 2;
  double half_wheelset_spacing_m = kRequired;
  double middle_wheelset_offset_m = 0.0;
  double coupler_height_m = kRequired;
  WheelRailParams wheel_rail;
  LinearSpringDamper adaptor_pad;
  SpringNestParams spring_nest;
  std::optional<FrictionWedgeParams> friction_wedge;
  LinearSpringDamper bolster_guide;
  double bolster_guide_height_m = kRequired;
  CentrePlateParams centre_plate;
  BrakeRiggingParams brake_rigging;
  std::optional<SlideProtectionParams> wheel_slide_protection;
  PropulsionResistanceParams propulsion_resistance;
  CurvingResistanceParams curving_resistance;
  std::optional<TractionParams> traction;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the vehicle, for people");
    v.Number("length_m", length_m, kPositive, "length over couplers");
    v.Number("mass_kg", mass_kg, kPositive,
             "mass without load; given: the vehicle is one mass without bodies, for LTD models only");
    v.Group("load", load, "what the vehicle carries when it is full, beside mass_kg or the bodies");
    v.Number("load_fraction", load_fraction, kFraction, "how much of that it carries; not given: all");
    v.Check(load || !load_fraction, "load_fraction", "needs load: what the vehicle carries when it is full", {"load"});
    if (IsOneMass()) {
      v.Integer("axles", axles, Range{1.0, 1000.0, false, false},
                "number of axles of a vehicle with mass_kg, of all units of an articulated one");
      v.Number("rotating_mass_kg", rotating_mass_kg, kNonNegative,
               "m_e of a vehicle with mass_kg: equivalent mass of its wheelsets and drives together");
    } else {
      VisitBodies(v);
    }
    v.Group("brake_rigging", brake_rigging, "brake rigging, from cylinder pressure to the shoes' tangential force");
    v.Part("wheel_slide_protection", wheel_slide_protection, "slide_protection",
           "wheel-slide protection (2D model); not given: none");
    v.Group("propulsion_resistance", propulsion_resistance, "resistance of straight level track");
    v.Group("curving_resistance", curving_resistance, "resistance of curves");
    v.Part("traction", traction, "traction", "traction equipment; given: the vehicle is a locomotive");
    v.Check(!traction || traction->driven_wheelsets.empty() || traction->driven_wheelsets.back() <= Wheelsets(),
            "traction.driven_wheelsets", "must name wheelsets that the vehicle has", {"traction"});
  }

  bool IsOneMass() const { return mass_kg.has_value(); }
  int Wheelsets() const { return IsOneMass() ? axles : 2 * wheelsets_per_bogie; }

  /// What it carries [kg].
  double LoadMass() const { return load ? load_fraction.value_or(1.0) * load->mass_kg : 0.0; }
  /// The carbody with what it carries: masses, moments and inertias about the common CG add up.
  BodyParams LoadedCarbody() const {
    if (!load) return carbody;
    const double load_kg = LoadMass(), load_height_m = load->cg_height_m.value_or(carbody.cg_height_m);
    BodyParams both;
    both.mass_kg = carbody.mass_kg + load_kg;
    both.cg_height_m = (carbody.mass_kg * carbody.cg_height_m + load_kg * load_height_m) / both.mass_kg;
    const double down_m = both.cg_height_m - carbody.cg_height_m, up_m = load_height_m - both.cg_height_m;
    both.pitch_inertia_kgm2 = carbody.pitch_inertia_kgm2 + carbody.mass_kg * down_m * down_m +
                              load_fraction.value_or(1.0) * load->pitch_inertia_kgm2.value_or(0.0) +
                              load_kg * up_m * up_m;
    return both;
  }

  /// Mass of the whole vehicle [kg].
  double TotalMass() const {
    if (IsOneMass()) return *mass_kg + LoadMass();
    return LoadedCarbody().mass_kg + 2.0 * (bolster.mass_kg + 4.0 * wedge_mass_kg) + 2.0 * bogie_frame.mass_kg +
           Wheelsets() * wheelset.mass_kg;
  }
  double Weight() const { return kGravity * TotalMass(); }  ///< [N]
  BrakeRigging Rigging() const { return {brake_rigging, TotalMass(), Weight()}; }
  ResistanceCoefficients Resistance() const { return CoefficientsOf(propulsion_resistance, TotalMass(), Wheelsets()); }
  /// On the driven wheels [N].
  double DrivenWeight() const { return traction ? Weight() * traction->DrivenOf(Wheelsets()) / Wheelsets() : 0.0; }
  /// Pitch inertia of a wheelset with what its drive adds [kg m^2]. @param i  from 0
  double PitchInertia(int i) const {
    const bool driven = traction && traction->Drives(i);
    return driven ? wheelset.pitch_inertia_kgm2 + traction->drive_inertia_kgm2 : wheelset.pitch_inertia_kgm2;
  }

 private:
  /// The keys of the 2D model.
  template <class Visitor>
  void VisitBodies(Visitor& v) {
    v.Group("carbody", carbody, "carbody, without load");
    v.Group("bolster", bolster, "one bolster, without the wedges");
    v.Group("bogie_frame", bogie_frame, "the two side frames of a bogie as one body");
    v.Group("wheelset", wheelset, "one wheelset");
    v.Number("wedge_mass_kg", wedge_mass_kg, kNonNegative,
             "mass of one of the eight wedges; it moves with its bolster");
    v.Number("half_bogie_spacing_m", half_bogie_spacing_m, kPositive,
             "distance of each bogie's centre from the vehicle's");
    v.Integer("wheelsets_per_bogie", wheelsets_per_bogie, Range{2.0, 3.0, false, false}, "2 or 3");
    v.Number("half_wheelset_spacing_m", half_wheelset_spacing_m, kPositive,
             "distance of the outer wheelsets of a bogie from its centre");
    v.Number("middle_wheelset_offset_m", middle_wheelset_offset_m, kFinite,
             "distance of the middle one of three wheelsets from the bogie's centre, positive away from the "
             "vehicle's centre");
    v.Number("coupler_height_m", coupler_height_m, kPositive, "height of the couplers above rail");
    v.Group("wheel_rail", wheel_rail, "contact of one wheel with its rail; two per wheelset");
    v.Group("adaptor_pad", adaptor_pad, "one of two axle-box adaptor pads per wheelset; the same in x and z");
    v.Group("spring_nest", spring_nest, "a quarter of a bogie's springs");
    v.Group("friction_wedge", friction_wedge, "one of four friction wedges per bogie; not given: no wedges");
    v.Group("bolster_guide", bolster_guide, "longitudinal guide of the bolster in the frame");
    v.Number("bolster_guide_height_m", bolster_guide_height_m, kPositive, "height of that guide above rail");
    v.Group("centre_plate", centre_plate, "centre plate between carbody and bolster");
    v.Check(wheelsets_per_bogie == 3 || middle_wheelset_offset_m == 0.0, "middle_wheelset_offset_m",
            "belongs to wheelsets_per_bogie 3 only", {"wheelsets_per_bogie"});
    v.Check(std::abs(middle_wheelset_offset_m) < half_wheelset_spacing_m, "middle_wheelset_offset_m",
            "must lie between the outer wheelsets, at most half_wheelset_spacing_m from the bogie's centre",
            {"half_wheelset_spacing_m"});
    v.Check(friction_wedge.has_value() || wedge_mass_kg == 0.0, "friction_wedge",
            "must be given, or wedge_mass_kg be 0 for a vehicle without wedges", {"wedge_mass_kg"});
    v.Check(2.0 * (half_bogie_spacing_m + half_wheelset_spacing_m) < length_m, "length_m",
            "must exceed the distance between the outer wheelsets",
            {"half_bogie_spacing_m", "half_wheelset_spacing_m"});
    v.Check(!load || (load->cg_height_m && load->pitch_inertia_kgm2), "load",
            "must have cg_height_m and pitch_inertia_kgm2 where the vehicle has bodies", {"load"});
  }
};

}  // namespace train_dynamics
