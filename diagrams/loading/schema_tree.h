// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For the source files that show the schema in another form; not installed.

#include <nlohmann/json_fwd.hpp>

#include "oca/diagrams/files/catalogue.h"

namespace oca::loading {

/// What DiagramSchema prints.
nlohmann::ordered_json DiagramSchemaTree(const files::Catalogue& catalogue);

}  // namespace oca::loading
