// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/loading/loaded_diagram.h"

namespace oca::runs {

/// The systems of a diagram and their connections, those of a used file within a frame, as a text
/// of Graphviz. An edge is solid if it is computed within the instant, dashed if it shows a held
/// state, which is what closes loops.
std::string DotGraph(const loading::LoadedDiagram& loaded);

/// The same as a flowchart of Mermaid.
std::string MermaidGraph(const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
