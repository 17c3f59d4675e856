#include "train_dynamics/numeric/monotone_cubic.h"

#include <math.h>  // pchip of Boost 1.74 calls isnan without its namespace

#include <boost/math/interpolators/pchip.hpp>

namespace train_dynamics {

double MonotoneCubic(const std::vector<double>& x, const std::vector<double>& y, double at) {
  return boost::math::interpolators::pchip(std::vector<double>(x), std::vector<double>(y))(at);
}

}  // namespace train_dynamics
