// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/per_component.h"
#include "oca/framework/dataflow/period.h"

namespace oca::systems {

// How the fields of a Params struct go together, which its Describe cannot say and Validated cannot
// check; ask them of fields that are Validated. `where` is the key of the parameter. All throw
// ConfigError.

/// Refuses a number that is not above `bound`, or below it.
void RequireAbove(const char* where, double value, double bound);
void RequireAtLeast(const char* where, double value, double bound);
/// Refuses lists of different length and a lower number above its upper one.
void RequireOrdered(const char* lower_key, const PerComponent& lower, const char* upper_key,
                    const PerComponent& upper);
/// Refuses a period of zero, which may be left out elsewhere.
void RequirePositive(const char* where, const Period& value);
/// Refuses a gain (1/s) above 1 / period, which would ask for more than all within one period.
void RequireGain(const char* where, double gain, const Period& period);

}  // namespace oca::systems
