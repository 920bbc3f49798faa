// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "oca/framework/simulation/integrator.h"

namespace oca {

/// The adaptive integrators of SUNDIALS: ARKODE's ERKStep with a named table, or CVODE.
/// throws ConfigError for a kind that is not SUNDIALS', SimulationError if memory runs out.
std::unique_ptr<Integrator> MakeSundialsIntegrator(const Schedule& schedule,
                                                   const IntegratorOptions& options);

}  // namespace oca
