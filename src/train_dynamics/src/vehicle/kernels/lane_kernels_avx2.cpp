#include "lane_laws.h"

namespace train_dynamics {

const LaneKernels kAvx2LaneKernels = KernelsOver<Lanes<4>>("avx2");

}  // namespace train_dynamics
