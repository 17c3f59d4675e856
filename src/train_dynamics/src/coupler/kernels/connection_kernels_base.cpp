#include "connection_laws.h"
#include "row_laws.h"

namespace train_dynamics {

const ConnectionKernels kScalarConnectionKernels = ConnectionKernelsOver<double>();
const ConnectionKernels kBaseConnectionKernels = ConnectionKernelsOver<Lanes<2>>();
const RowKernels kScalarRowKernels = RowKernelsOver<double>();
const RowKernels kBaseRowKernels = RowKernelsOver<Lanes<2>>();

}  // namespace train_dynamics
