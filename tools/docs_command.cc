// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/reference_pages.h"
#include "tools/terminal.h"

namespace oca::tools {

int DocsCommand(const std::string& page, const diagrams::Catalogue& catalogue) {
  WriteOutput(page == "systems" ? SystemsPage(catalogue) : DiagramFilePage(catalogue));
  return kFine;
}

}  // namespace oca::tools
