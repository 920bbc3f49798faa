// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/verification/problems.h"

namespace oca::verification {

/// What SUNDIALS itself reaches, called as its examples call it: its own vectors and tolerances, a
/// restart wherever a held control changes, nothing of the framework.
///
/// A fixed_dp5 is ERKStep with fixed steps; so is fixed_rk4, with the table of Zonneveld, whose
/// solution of order 4 is the classical method of Kutta.
/// throws std::runtime_error if SUNDIALS refuses.
Outcome Measure(const Problem& problem, const IntegratorOptions& options);

}  // namespace oca::verification
