#include "connection_laws.h"

namespace train_dynamics {

const ConnectionKernels kScalarConnectionKernels = ConnectionKernelsOver<double>();
const ConnectionKernels kBaseConnectionKernels = ConnectionKernelsOver<Lanes<2>>();

}  // namespace train_dynamics
