// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// Warnings about motions that nobody can make as the file asks for them, a line each with its
/// place, found without a run: of each robot that is judged and whose request is known ahead
///
/// - a start or a request beyond the limits of a position
/// - a request that begins elsewhere than the arm stands, by more than 1e-3 rad or m, or ends after
///   the run
/// - joints beside the arm (planning::JointsBesideArm) that the request leaves where they are, on a
///   branch of which it moves none, and that what evades may move
/// - a request faster than a limit of a speed, or that needs more than one of an acceleration
/// - contact at the start, and at the end of the request with what is there then
/// - a request to whose end a bounded search found no way past what stands (NoWayText)
///
/// Of what depends on the run, as what a sensor sees, nothing is said.
std::vector<std::string> RequestWarnings(const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
