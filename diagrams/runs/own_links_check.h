// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// Warnings about own links where the arm stands first, a line a distance block that looks at them
/// (systems::MeasuresDistances), with its place: each pair that is in contact, and each that is
/// nearer than its self_distance, which is then asked for what the request leaves.
std::vector<std::string> OwnLinkWarnings(const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
