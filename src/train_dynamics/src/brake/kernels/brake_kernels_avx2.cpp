#include "brake_laws.h"

namespace train_dynamics {

const BrakeKernels kAvx2BrakeKernels = BrakeKernelsOver<Lanes<4>>();

}  // namespace train_dynamics
