// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// What whoever runs, records or shows a diagram is to be told of it, a line each with its place:
/// OwnLinkWarnings and ChatterWarnings.
std::vector<std::string> RunWarnings(const loading::LoadedDiagram& loaded);
/// Puts them beside those of the file.
void AddRunWarnings(loading::LoadedDiagram& loaded);

}  // namespace oca::runs
