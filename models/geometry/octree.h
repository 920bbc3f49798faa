// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "oca/models/geometry/shape.h"

namespace oca::geometry {

/// The occupied leaves of an OctoMap file, each a box, in the frame of the file, m:
///
///   .bt  its binary form: leaves are free or occupied
///   .ot  its full form, `id OcTree`: a leaf whose log-odds are not below 0 is occupied
///
/// What was never seen is free. Both are read here: OctoMap's own reader takes a cut file for
/// whatever its memory holds, and follows a bad one until the stack ends.
/// throws ModelError `file: ...`: missing, above 100 MB, unknown extension or head, cut short, more
///        than 16 levels or a million occupied leaves, another number of nodes than announced,
///        log-odds that are NaN, no occupied leaf
/// source Hornung et al. 2013, OctoMap; octomap 1.9, OccupancyOcTreeBase::writeBinaryNode
Compound LoadOctree(const std::filesystem::path& file);

}  // namespace oca::geometry
