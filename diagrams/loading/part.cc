// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/part.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/nearest.h"

namespace oca::loading {

bool Part::Has(const std::string& system) const {
  return whole() || std::any_of(systems_.begin(), systems_.end(), [&](const std::string& name) {
           return system == name || system.starts_with(name + ".");
         });
}

void Part::CheckNames(const std::vector<std::string>& known, const Location& location,
                      Problems& problems) const {
  for (const std::string& name : systems_) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    problems.Add(location, fmt::format("part: no system '{}'{}", name, DidYouMean(name, known)));
  }
}

}  // namespace oca::loading
