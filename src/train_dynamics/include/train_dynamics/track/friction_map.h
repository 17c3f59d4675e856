#pragma once

#include <optional>

#include "train_dynamics/contact/adhesion.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// A patch of rail with a surface of its own, on [from_m, to_m), in place of the vehicles' `wheel_rail.adhesion`: either
/// mu0 alone, beside which A, B, kA and kS stay the vehicle's, or a whole adhesion part.
///
/// Around each end of a patch that has a ramp, over [end - ramp_length_m / 2, end + ramp_length_m / 2], mu0, A, B, kA
/// and kS go linearly from the surface before to the one behind. Where two patches touch, the longer ramp holds.
struct FrictionPatchParams {
  double from_m = kRequired;
  double to_m = kRequired;
  std::optional<double> friction_coefficient{};  ///< mu0
  std::optional<AdhesionParams> adhesion{};
  std::optional<double> ramp_length_m{};  ///< default 1 m [A] with `adhesion`, else 0: a sharp end

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("from_m", from_m, kFinite);
    v.Number("to_m", to_m, kFinite);
    v.Number("friction_coefficient", friction_coefficient, Range{0.0, 1.0, true, false});
    v.Part("adhesion", adhesion, "adhesion");
    v.Number("ramp_length_m", ramp_length_m, kNonNegative);
    v.Check(from_m < to_m, "to_m", "must be greater than from_m", {"from_m"});
    v.Check(friction_coefficient || adhesion, "friction_coefficient", "must be given, or else adhesion",
            {"adhesion"});
    v.Check(!(friction_coefficient && adhesion), "friction_coefficient",
            "must not stand beside adhesion, which has one", {"adhesion"});
  }

  double RampLength() const { return ramp_length_m.value_or(adhesion ? 1.0 : 0.0); }  ///< [m]
};

}  // namespace train_dynamics
