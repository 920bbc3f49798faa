// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::tools {

/// From now on the first SIGINT or SIGTERM is remembered, so that what runs can end in order; a
/// second one ends the program.
void CatchInterrupts();
/// Whether such a signal has come.
bool Interrupted();

}  // namespace oca::tools
