#include "brake_laws.h"

namespace train_dynamics {

const BrakeKernels kScalarBrakeKernels = BrakeKernelsOver<double>();
const BrakeKernels kBaseBrakeKernels = BrakeKernelsOver<Lanes<2>>();

}  // namespace train_dynamics
