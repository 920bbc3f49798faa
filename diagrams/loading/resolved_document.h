// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/sampling/scenario.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// A diagram file as text that means one diagram.
struct ResolvedDocument {
  Value document;               ///< includes merged, scenario drawn, overrides applied
  Value root;                   ///< the same without parameters, ${...} worked out
  sampling::Scenario scenario;  ///< what was drawn
  files::DocumentSources sources;
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
/// ${...}. What is wrong with an expression or a key is added to `problems`.
/// `given`, if another file uses this one, takes the place of its parameters; it may draw no
/// scenario then. throws ConfigError with all problems if there are any before that
ResolvedDocument ReadResolved(const std::filesystem::path& file,
                              const std::vector<files::Override>& overrides,
                              const files::Catalogue& catalogue, Problems& problems,
                              const GivenParameters* given = nullptr);

}  // namespace oca::loading
