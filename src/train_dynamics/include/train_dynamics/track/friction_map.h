#pragma once

#include <cstddef>
#include <optional>

#include "train_dynamics/contact/adhesion.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A patch of rail with a surface of its own, on [from_m, to_m), in place of the vehicles' `wheel_rail.adhesion`:
/// either mu0 alone, beside which A, B, kA and kS stay the vehicle's, or a whole adhesion part.
///
/// Around each end of a patch that has a ramp, over [end - ramp_length_m / 2, end + ramp_length_m / 2], mu0, A, B, kA
/// and kS go linearly from the surface before to the one behind. Where two patches touch, the longer ramp holds.
struct FrictionPatchParams {
  double from_m = kRequired;
  double to_m = kRequired;
  std::optional<double> friction_coefficient{};
  std::optional<AdhesionParams> adhesion{};
  std::optional<double> ramp_length_m{};

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite, "position at which the patch begins");
    v.Number("to_m", to_m, kFinite, "position at which the patch ends");
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false},
             "mu0 of the patch; the rest of the adhesion stays the vehicle's");
    v.Part("adhesion", adhesion, "adhesion", "whole adhesion of the patch, in place of friction_coefficient");
    v.Number("ramp_length_m", ramp_length_m, kNonNegative,
             "length around each end of the patch over which the surface changes linearly; default 1 m [A] "
             "with adhesion, else 0");
    v.Check(from_m < to_m, "to_m", "must be greater than from_m", {"from_m"});
    v.Check(friction_coefficient || adhesion, "friction_coefficient", "must be given, or else adhesion", {"adhesion"});
    v.Check(!(friction_coefficient && adhesion), "friction_coefficient",
            "must not stand beside adhesion, which has one", {"adhesion"});
  }

  double RampLength() const { return ramp_length_m.value_or(adhesion ? 1.0 : 0.0); }  ///< [m]
};

inline constexpr std::size_t kMostPatchesOnTheWay = 100;  ///< patches that are added during a run

}  // namespace train_dynamics
