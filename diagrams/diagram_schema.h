// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "diagrams/catalogue.h"

namespace oca::diagrams {

/// JSON Schema (draft 7) of diagram files with systems of these types, for editors.
std::string DiagramSchema(const Catalogue& catalogue = Catalogue::Standard());

}  // namespace oca::diagrams
