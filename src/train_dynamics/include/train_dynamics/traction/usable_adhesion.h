#pragma once

#include <cmath>
#include <limits>

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// The law that limits the effort of a locomotive's driven wheels to the adhesion of the rail.
enum class UsableAdhesionLaw {
  kCurtiusKniffler,  ///< falls over the speed
  kConstant,
  kUnlimited  ///< the effort is not limited; the 2D model's creep forces limit it all the same
};

/// The adhesion that a locomotive's control uses.
struct UsableAdhesionParams {
  UsableAdhesionLaw law = UsableAdhesionLaw::kCurtiusKniffler;
  double coefficient = 0.36;
  double factor = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Choice("law", law,
             {{"curtius_kniffler", UsableAdhesionLaw::kCurtiusKniffler},
              {"constant", UsableAdhesionLaw::kConstant},
              {"unlimited", UsableAdhesionLaw::kUnlimited}},
             "curtius_kniffler: falls over speed; constant: coefficient; unlimited: the effort is not limited");
    if (law == UsableAdhesionLaw::kConstant) {
      v.Number("coefficient", coefficient, Range{0.02, 0.5, false, false},
               "effort over the weight on driven wheels (modern AC locomotives: 0.36 to 0.43 claimed)");
    }
    v.Number("factor", factor, Range{0.1, 2.0, false, false}, "factor on the law: 1 for a dry rail, 1.2 with sand");
  }
};

/// Adhesion of a dry rail after Curtius and Kniffler [-]: 0.161 + 7.5 / (k + 44), k = |speed| in km/h. [S]
inline double CurtiusKniffler(double speed_mps) { return 0.161 + 7.5 / (3.6 * std::abs(speed_mps) + 44.0); }

/// The usable adhesion [-] at a speed [m/s], even in it; infinite for `unlimited`.
inline double UsableAdhesion(const UsableAdhesionParams& p, double speed_mps) {
  switch (p.law) {
    case UsableAdhesionLaw::kConstant:
      return p.factor * p.coefficient;
    case UsableAdhesionLaw::kUnlimited:
      return std::numeric_limits<double>::infinity();
    default:
      return p.factor * CurtiusKniffler(speed_mps);
  }
}

}  // namespace train_dynamics
