// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "framework/per_component.h"
#include "framework/period.h"

namespace oca::systems {

// Refusals that constructors share. A Params struct filled in C++ has not passed the bounds that
// the reader checks, so a constructor checks what it would crash or compute nonsense with.
// `where` is the key of the parameter. All throw ConfigError.

/// Refuses an empty list, a NaN and an infinity.
void RequireFinite(const char* where, const PerComponent& value);
/// Refuses that, and a number that is not above `bound`.
void RequireAbove(const char* where, const PerComponent& value, double bound);
/// Refuses that, and a number below `bound`.
void RequireAtLeast(const char* where, const PerComponent& value, double bound);
/// Refuses lists of different length and a lower number above its upper one.
void RequireOrdered(const char* lower_key, const PerComponent& lower, const char* upper_key,
                    const PerComponent& upper);
/// Refuses a period that is zero or negative.
void RequirePositive(const char* where, const Period& value);
/// Refuses a period that is negative; zero stands for "none".
void RequireNotNegative(const char* where, const Period& value);

}  // namespace oca::systems
