// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/sampling/scenario.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// A diagram file as text that means one diagram.
struct ResolvedDocument {
  Value document;               ///< includes merged, scenario drawn, overrides applied
  Value root;                   ///< the same without parameters, ${...} worked out
  sampling::Scenario scenario;  ///< what was drawn
  std::shared_ptr<const files::DocumentSources> sources;
  std::vector<Diagnostic> warnings;  ///< of parameters that nothing uses
  /// Of files that it uses, by the names of the systems that they are.
  std::map<std::string, std::vector<files::Override>> inner_overrides;
};

/// What another file gives to a diagram file that it uses.
struct GivenParameters {
  Value map;           ///< from names to values
  std::string where;   ///< it stands there, for messages: `systems.left.parameters`
  Problems* problems;  ///< of the other file
};

/// Reads the file and those it includes, draws its scenario, applies `overrides` and works out all
/// ${...}, except for what `construction` has from earlier. What is wrong with an expression or a
/// key is added to `problems`. `use` is the path at which another file uses this one; `given` then
/// takes the place of its parameters, and it may draw no scenario.
/// throws ConfigError with all problems if there are any before that
ResolvedDocument ReadResolved(const std::filesystem::path& file,
                              const std::vector<files::Override>& overrides,
                              Construction& construction, Problems& problems,
                              const std::string& use = "", const GivenParameters* given = nullptr);

}  // namespace oca::loading
