#include "connection_laws.h"

namespace train_dynamics {

const ConnectionKernels kAvx512ConnectionKernels = ConnectionKernelsOver<Lanes<8>>();

}  // namespace train_dynamics
