// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"

namespace oca::runs {

/// Gives `to`, of diagram `next`, every state that `from`, of diagram `previous`, has now: a run
/// goes on where it was, with other parameters. Time and events are left as they are.
/// throws ConfigError, with nothing changed, unless both diagrams have the same systems with the
/// same states.
void AdoptStates(const Diagram& previous, const Context& from, const Diagram& next, Context& to);

}  // namespace oca::runs
