#include "lane_laws.h"

namespace train_dynamics {

const LaneKernels kAvx512LaneKernels = KernelsOver<Lanes<8>>("avx512");

}  // namespace train_dynamics
