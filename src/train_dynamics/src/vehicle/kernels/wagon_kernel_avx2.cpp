#include "wagon_kernel.h"

namespace train_dynamics {

const WagonKernel kAvx2WagonKernel{"avx2", 4, &StepPack<Lanes<4>>};

}  // namespace train_dynamics
