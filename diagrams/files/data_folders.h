// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace oca::files {

/// Where what comes with OCA may lie, the first that has it counts: `models/`, `diagrams/` and the
/// page of the viewer. In this order: beside the program (../share/oca), in the installation that
/// the program was built with, in the sources that OCA was built from.
std::vector<std::filesystem::path> DataFolders();

/// Tells of one more, before those of the sources. Whoever links an installed OCA does so before
/// main, by a source file that find_package(oca) adds to the program.
void AddDataFolder(const std::filesystem::path& folder);

}  // namespace oca::files
