#include "connection_laws.h"
#include "row_laws.h"

namespace train_dynamics {

const ConnectionKernels kAvx512ConnectionKernels = ConnectionKernelsOver<Lanes<8>>();
const RowKernels kAvx512RowKernels = RowKernelsOver<Lanes<8>>();

}  // namespace train_dynamics
