#include "lane_laws.h"

namespace train_dynamics {

const LaneKernels kScalarLaneKernels = KernelsOver<double>("scalar");
const LaneKernels kBaseLaneKernels = KernelsOver<Lanes<2>>("base");

}  // namespace train_dynamics
