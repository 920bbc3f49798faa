// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/files/catalogue.h"

namespace oca::loading {

/// JSON Schema (draft 7) of diagram files with systems of these types, for editors.
std::string DiagramSchema(const files::Catalogue& catalogue = files::Catalogue::Standard());

}  // namespace oca::loading
