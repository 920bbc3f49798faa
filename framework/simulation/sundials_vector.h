// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the SUNDIALS integrator.

#include <nvector/nvector_serial.h>

namespace oca::internal {

/// A serial N_Vector over `data`, with operations compiled here.
///
/// Debian builds SUNDIALS without optimisation, which makes its own vector operations about four
/// times slower than these. Clones inherit the operations, and the vector keeps its serial
/// identity, so that dense linear solvers accept it.
N_Vector MakeSerialVector(sunindextype size, double* data, SUNContext context);

}  // namespace oca::internal
