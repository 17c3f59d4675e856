#include "train_dynamics/contact/polach.h"

#include <boost/math/constants/constants.hpp>

namespace train_dynamics {

double CreepStiffness(const ContactEllipse& ellipse, double shear_modulus_pa, double kalker_c11) {
  constexpr double kPi = boost::math::constants::pi<double>();
  return shear_modulus_pa * kPi * ellipse.a_per_cbrt_n * ellipse.b_per_cbrt_n * kalker_c11 / 4.0;
}

}  // namespace train_dynamics
