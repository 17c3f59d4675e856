#include "brake_laws.h"

namespace train_dynamics {

const BrakeKernels kAvx512BrakeKernels = BrakeKernelsOver<Lanes<8>>();

}  // namespace train_dynamics
