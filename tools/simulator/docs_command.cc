// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "tools/simulator/commands.h"
#include "tools/simulator/reference_pages.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {

int DocsCommand(const std::string& page, const files::Catalogue& catalogue) {
  WriteOutput(page == "systems" ? SystemsPage(catalogue) : DiagramFilePage(catalogue));
  return kFine;
}

}  // namespace oca::tools
