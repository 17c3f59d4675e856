#include "train_dynamics/brake/brake_kernels.h"

#include "brake_laws.h"

namespace train_dynamics {

const std::vector<BrakeKernels>& AllBrakeKernels() {
#if defined(TRAIN_BRAKE_X86_KERNELS)
  static const std::vector<BrakeKernels> kernels =
      RunnableKernels(&kAvx512BrakeKernels, &kAvx2BrakeKernels, kBaseBrakeKernels, kScalarBrakeKernels);
#else
  static const std::vector<BrakeKernels> kernels =
      RunnableKernels<BrakeKernels>(nullptr, nullptr, kBaseBrakeKernels, kScalarBrakeKernels);
#endif
  return kernels;
}

}  // namespace train_dynamics
