#include "connection_laws.h"

namespace train_dynamics {

const ConnectionKernels kAvx2ConnectionKernels = ConnectionKernelsOver<Lanes<4>>();

}  // namespace train_dynamics
