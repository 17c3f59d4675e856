#include "train_dynamics/slide_protection/slide_protection.h"

#include <cmath>

namespace train_dynamics {

SlideProtection::SlideProtection(const SlideProtectionParams& params, double dt)
    : params_(params),
      law_(params.Law()),
      valve_(params.valve, dt),
      period_s_(params.sampling_period_s),
      period_steps_(std::lround(params.sampling_period_s / dt)),
      delay_steps_(std::lround(params.valve.delay_s / dt)) {}

}  // namespace train_dynamics
