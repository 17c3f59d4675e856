#include "train_dynamics/coupler/connection_kernels.h"

#include "connection_laws.h"
#include "train_dynamics/coupler/row_kernels.h"

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

const std::vector<RowKernels>& AllRowKernels() {
#if defined(TRAIN_BRAKE_X86_KERNELS)
  static const std::vector<RowKernels> kernels =
      RunnableKernels(&kAvx512RowKernels, &kAvx2RowKernels, kBaseRowKernels, kScalarRowKernels);
#else
  static const std::vector<RowKernels> kernels =
      RunnableKernels<RowKernels>(nullptr, nullptr, kBaseRowKernels, kScalarRowKernels);
#endif
  return kernels;
}

}  // namespace train_dynamics
