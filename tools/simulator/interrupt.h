// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::tools {

/// From now on SIGINT or SIGTERM ends the program at once, with kInterrupted; files that are half
/// written go (models::RemoveUnfinished). So every command ends that does nothing else.
void EndOnInterrupts();
/// From now on the first one is remembered, so that what runs can end in order; a second one ends
/// the program at once.
void CatchInterrupts();
/// Whether such a signal has come.
bool Interrupted();

}  // namespace oca::tools
