#include "train_dynamics/coupler/connection_kernels.h"

#include "connection_laws.h"

namespace train_dynamics {

const std::vector<ConnectionKernels>& AllConnectionKernels() {
#if defined(TRAIN_BRAKE_X86_KERNELS)
  static const std::vector<ConnectionKernels> kernels = RunnableKernels(
      &kAvx512ConnectionKernels, &kAvx2ConnectionKernels, kBaseConnectionKernels, kScalarConnectionKernels);
#else
  static const std::vector<ConnectionKernels> kernels =
      RunnableKernels<ConnectionKernels>(nullptr, nullptr, kBaseConnectionKernels, kScalarConnectionKernels);
#endif
  return kernels;
}

}  // namespace train_dynamics
