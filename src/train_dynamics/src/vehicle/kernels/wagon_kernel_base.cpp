#include "wagon_kernel.h"

namespace train_dynamics {

const WagonKernel kScalarWagonKernel{"scalar", 1, &StepPack<double>};
const WagonKernel kBaseWagonKernel{"base", 2, &StepPack<Lanes<2>>};

}  // namespace train_dynamics
