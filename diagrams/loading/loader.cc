// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/loader.h"

namespace oca::loading {

LoadedDiagram LoadDiagram(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides,
                          const files::Catalogue& catalogue) {
  return Blueprint(file, catalogue).Build(overrides);
}

}  // namespace oca::loading
