#include "wagon_kernel.h"

namespace train_dynamics {

const WagonKernel kAvx512WagonKernel{"avx512", 8, &StepPack<Lanes<8>>};

}  // namespace train_dynamics
