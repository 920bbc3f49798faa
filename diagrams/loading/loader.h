// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"

namespace oca::loading {

/// Reads, checks and builds a diagram file: a Blueprint and a Build of it.
///
/// Files are looked up relative to the file that names them; `package://NAME/` in the file's
/// `packages`, then in OCA_PACKAGE_PATH, then among the models that come with OCA.
/// `catalogue` has the types of its systems.
/// throws ConfigError as Build does
LoadedDiagram LoadDiagram(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides = {},
                          const files::Catalogue& catalogue = files::Catalogue::Standard());

}  // namespace oca::loading
