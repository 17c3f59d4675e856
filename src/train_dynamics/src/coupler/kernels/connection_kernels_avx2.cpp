#include "connection_laws.h"
#include "row_laws.h"

namespace train_dynamics {

const ConnectionKernels kAvx2ConnectionKernels = ConnectionKernelsOver<Lanes<4>>();
const RowKernels kAvx2RowKernels = RowKernelsOver<Lanes<4>>();

}  // namespace train_dynamics
