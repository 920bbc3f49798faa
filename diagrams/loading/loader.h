// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/loading/loaded_diagram.h"

namespace oca::loading {

/// Reads, checks and builds a diagram file.
///
/// Files are looked up relative to the file that names them; `package://NAME/` in the file's
/// `packages`, then in OCA_PACKAGE_PATH, then among the models that come with OCA.
/// `catalogue` has the types of its systems.
/// throws ConfigError with all problems of the file, a line each, `file:line:column: error: ...`.
LoadedDiagram LoadDiagram(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides = {},
                          const files::Catalogue& catalogue = files::Catalogue::Standard());

/// As LoadDiagram; obstacles can be moved: each system that holds obstacles (HoldsObstacles) whose
/// `offsets` nothing drives has them exported as `NAME_offsets`, which must be fixed before a run.
LoadedDiagram LoadMovable(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides = {},
                          const files::Catalogue& catalogue = files::Catalogue::Standard());

/// The named systems of a diagram file alone, for a program that takes the place of the others, as
/// a robot's control loop does with the plant; the whole file is checked all the same.
///
/// Where a system outside drives one inside, the diagram exports an input with the name of that
/// output, `plant.position` as `plant_position`; every output inside is exported in the same way.
/// What the file records and expects is left out.
/// throws ConfigError as LoadDiagram does, and if there is no system of a name.
LoadedDiagram LoadPart(const std::filesystem::path& file, const std::vector<std::string>& systems,
                       const std::vector<files::Override>& overrides = {},
                       const files::Catalogue& catalogue = files::Catalogue::Standard());

}  // namespace oca::loading
