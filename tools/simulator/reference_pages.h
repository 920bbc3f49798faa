// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/files/catalogue.h"

namespace oca::tools {

/// Every system of the catalogue in Markdown: a table of all, then of each its equation, source,
/// ports with units, and parameters with units, defaults and bounds.
std::string SystemsPage(const files::Catalogue& catalogue);

/// The keys of a diagram file in Markdown, as DiagramSchema has them.
std::string DiagramFilePage(const files::Catalogue& catalogue);

}  // namespace oca::tools
